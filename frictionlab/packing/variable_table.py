"""Writes the C variable table of fmu_src/fmi2/variables.h from modelDescription.xml.

usage: python -m frictionlab.packing.variable_table modelDescription.xml variables.c
"""

from __future__ import annotations

import sys
from pathlib import Path

from frictionlab.packing import model_description
from frictionlab.packing.model_description import ModelDescription, Variable


def table(description: ModelDescription) -> str:
    lines = [
        "// Generated from modelDescription.xml; edit that.",
        '#include "fmi2/variables.h"',
        '#include "friction_contact.h"',
        "",
        "#include <float.h>",
        "",
        f"const char fc_guid[] = {_string(description.guid)};",
        f"const char fc_model_identifier[] = {_string(description.model_identifier)};",
        "",
        "const char* const fc_log_categories[] = {",
        *(f"    {_string(name)}," for name in description.log_categories),
        "};",
        f"const unsigned fc_log_categories_count = {len(description.log_categories)};",
        "",
    ]
    for name, literals in description.enumerations.items():
        names = ", ".join(_string(literal) for literal in literals)
        lines.append(f"static const char* const literals_of_{name}[] = {{{names}}};")
    lines += ["", *(_type_check(variable) for variable in description.variables), ""]
    lines += [
        "const FcVariableInfo fc_variables[] = {",
        *(_row(variable) for variable in description.variables),
        "};",
        f"const unsigned fc_variables_count = {len(description.variables)};",
    ]
    return "\n".join(lines) + "\n"


def _type_check(variable: Variable) -> str:
    c_type = "double" if variable.kind == "Real" else "int"
    return (
        f"_Static_assert(_Generic(((FcVariables*)0)->{variable.name}, {c_type}: 1, default: 0),"
        f' "{variable.name} must be of type {c_type}");'
    )


def _row(variable: Variable) -> str:
    cells = [
        _string(variable.name),
        _string(variable.unit),
        f"FC_TYPE_{variable.kind.upper()}",
        f"FC_CAUSALITY_{variable.causality.upper()}",
        f"FC_VARIABILITY_{variable.variability.upper()}",
        "0" if variable.start is None else "1",
        _double(variable.start, "0.0"),
        _double(variable.min, "-DBL_MAX"),
        _double(variable.max, "DBL_MAX"),
        f"literals_of_{variable.declared_type}" if variable.declared_type else "NULL",
        f"offsetof(FcVariables, {variable.name})",
    ]
    return "    {" + ", ".join(cells) + "},"


def _double(value: float | None, absent: str) -> str:
    return absent if value is None else repr(value)


def _string(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def main() -> None:
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    target.write_text(table(model_description.read(source)), encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except (ValueError, KeyError) as error:
        sys.exit(f"modelDescription.xml: {error}")
