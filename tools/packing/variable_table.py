"""Writes the C tables of fmi2/variables.h from modelDescription.xml and frictioncontact/plausibility.py.

usage: python -m tools.packing.variable_table modelDescription.xml variables.c
"""

import sys
from pathlib import Path

from fmpy.model_description import ModelDescription, ScalarVariable

from frictioncontact.plausibility import LIKELY, USED
from tools.packing import model_description


def table(description: ModelDescription) -> str:
    lines = [
        "// Generated from modelDescription.xml and frictioncontact/plausibility.py; edit those.",
        '#include "fmi2/variables.h"',
        '#include "contact/friction_contact.h"',
        "",
        "#include <float.h>",
        "",
        f"const char fc_guid[] = {_string(description.guid)};",
        f"const char fc_model_identifier[] = {_string(description.coSimulation.modelIdentifier)};",
        f"const unsigned fc_event_indicators_count = {description.numberOfEventIndicators};",
        "",
        "const char* const fc_log_categories[] = {",
        *(f"    {_string(category.name)}," for category in description.logCategories),
        "};",
        f"const unsigned fc_log_categories_count = {len(description.logCategories)};",
        "",
    ]
    for enumeration in description.typeDefinitions:
        names = ", ".join(_string(item.name) for item in enumeration.items)
        lines.append(f"static const char* const literals_of_{enumeration.name}[] = {{{names}}};")
    variables = description.modelVariables
    inputs = [str(k) for k, variable in enumerate(variables) if variable.causality == "input"]
    lines += [
        *("", *map(_type_check, variables), ""),
        *("const FcVariableInfo fc_variables[] = {", *map(_row, variables), "};"),
        f"const unsigned fc_variables_count = {len(variables)};",
        f"const unsigned fc_inputs[] = {{{', '.join(inputs)}}};",
        f"const unsigned fc_inputs_count = {len(inputs)};",
        f'_Static_assert(FC_INPUT_COUNT == {len(inputs)}, "each input has an FcInput");',
        *_plausibility(description),
    ]
    return "\n".join(lines) + "\n"


def _plausibility(description: ModelDescription) -> list[str]:
    """Which settings are used, if one enumeration decides it, and which magnitudes are likely."""
    reference = {variable.name: k for k, variable in enumerate(description.modelVariables)}
    uses = []
    for setting, decider, items in USED:
        if items is not None:
            literals = description.modelVariables[reference[decider]].declaredType.items
            bits = sum(1 << k for k, literal in enumerate(literals) if literal.name in items)
            uses.append(f"    {{{reference[setting]}, {reference[decider]}, {bits}}}, // {setting}")
    likely = [f"    {{{reference[n]}, {low!r}, {high!r}}}, // {n}" for n, (low, high) in LIKELY.items()]
    lines = []
    for declaration, rows in (("FcUse fc_uses", uses), ("FcLikely fc_likely", likely)):
        count = f"const unsigned {declaration.split()[1]}_count = {len(rows)};"
        lines += ["", f"const {declaration}[] = {{", *rows, "};", count]
    return lines


def _type_check(variable: ScalarVariable) -> str:
    c_type = "double" if variable.type == "Real" else "int"
    member = model_description.c_member(variable.name)
    is_right = f"_Generic(((FcVariables*)0)->{member}, {c_type}: 1, default: 0)"
    return f'_Static_assert({is_right}, "{variable.name} must be of type {c_type}");'


def _row(variable: ScalarVariable) -> str:
    low, high = variable.min, variable.max
    if variable.type == "Enumeration":
        low, high = "1", str(len(variable.declaredType.items))
    cells = [
        _string(variable.name),
        _string(variable.unit or ""),
        f"FC_TYPE_{variable.type.upper()}",
        f"FC_CAUSALITY_{variable.causality.upper()}",
        f"FC_VARIABILITY_{variable.variability.upper()}",
        "0" if variable.start is None else "1",
        _double(variable.start, "0.0"),
        _double(low, "-DBL_MAX"),
        _double(high, "DBL_MAX"),
        f"literals_of_{variable.declaredType.name}" if variable.declaredType else "NULL",
        f"offsetof(FcVariables, {model_description.c_member(variable.name)})",
    ]
    return "    {" + ", ".join(cells) + "},"


def _double(value: str | None, absent: str) -> str:
    return absent if value is None else repr(float(value))


def _string(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


if __name__ == "__main__":
    try:
        source, target = map(Path, sys.argv[1:])
        target.write_text(table(model_description.read(source)), encoding="utf-8")
    except (ValueError, KeyError) as error:
        sys.exit(f"modelDescription.xml: {error}")
