"""The documentation inside the FMU: documentation/index.html, documentation/licenses/ and model.png.

    python -m frictionlab.fmu_docs.page index.html        writes the page

The page is docs/fmu/page.html with the plots of docs/fmu/ and tables of the variables of
modelDescription.xml put in. Nothing but Python's own library is needed: the build makes the page.
"""

from __future__ import annotations

import sys
from html import escape
from pathlib import Path
from xml.etree import ElementTree

from frictionlab.project import ROOT

FMU_DOCS = ROOT / "docs" / "fmu"
PLOTS = ("force", "mean")
CAUSALITIES = {"input": "Inputs", "output": "Outputs", "parameter": "Parameters", "local": "Local variables"}
# How units and the letters in them are written.
TYPOGRAPHY = {
    "um": "µm",
    "um2": "µm²",
    "mm2": "mm²",
    "m2": "m²",
    "1/m2": "1/m²",
    "1/mm2": "1/mm²",
    "deg": "°",
    "1": "",
}


def page(xml: Path, playground: bool = False) -> str:
    """The text of index.html; with a link to the page of the live FMU if that lies beside it."""
    root = ElementTree.parse(xml).getroot()
    text = (FMU_DOCS / "page.html").read_text(encoding="utf-8")
    parts = {"variables": variable_tables(root), "version": escape(root.attrib["version"])}
    parts |= {f"plot_{name}": (FMU_DOCS / f"{name}.svg").read_text(encoding="utf-8") for name in PLOTS}
    parts["playground"] = '<a href="playground.html">Try it live</a>' if playground else ""
    for name, part in parts.items():
        placeholder = f"<!-- {name} -->"
        if text.count(placeholder) != 1:
            raise ValueError(f"page.html must hold {placeholder} once")
        text = text.replace(placeholder, part.strip())
    return text


def variable_tables(root: ElementTree.Element) -> str:
    """One table for each causality, in the order of the model description."""
    display_factors = {
        (unit.attrib["name"], display.attrib["name"]): float(display.get("factor", "1"))
        for unit in root.iterfind("UnitDefinitions/Unit")
        for display in unit.iterfind("DisplayUnit")
    }
    literals = {
        simple_type.attrib["name"]: [
            (item.attrib["value"], item.attrib["name"], item.get("description", ""))
            for item in simple_type.iterfind("Enumeration/Item")
        ]
        for simple_type in root.iterfind("TypeDefinitions/SimpleType")
    }
    variables = root.findall("ModelVariables/ScalarVariable")
    tables = []
    for causality, title in CAUSALITIES.items():
        rows = [
            _row(variable, display_factors, literals)
            for variable in variables
            if variable.get("causality", "local") == causality
        ]
        if rows:
            tables.append(
                f"<h3>{title}</h3>\n<table>\n<thead><tr><th>Name</th><th>Unit</th><th>Start</th><th>Allowed</th>"
                "<th>Meaning</th></tr></thead>\n<tbody>\n" + "\n".join(rows) + "\n</tbody>\n</table>"
            )
    return "\n".join(tables)


def _row(
    variable: ElementTree.Element,
    display_factors: dict[tuple[str, str], float],
    literals: dict[str, list[tuple[str, str, str]]],
) -> str:
    kind = variable[0]
    meaning = escape(variable.get("description", ""))
    if variable.get("variability") == "tunable":
        meaning += ' <span class="tag">tunable</span>'
    if kind.tag == "Enumeration":
        options = literals[kind.attrib["declaredType"]]
        unit, start = "", next(name for value, name, _ in options if value == kind.get("start", "1"))
        allowed = f"{options[0][0]} … {options[-1][0]}"
        items = "".join(
            f"<li><code>{value}</code> {escape(name)}: {escape(text)}</li>" for value, name, text in options
        )
        meaning += f"<ul>{items}</ul>"
    else:
        unit = kind.attrib.get("unit", "")
        start = _start(kind, display_factors)
        allowed = _allowed(kind)
    cells = [("Unit", TYPOGRAPHY.get(unit, unit)), ("Start", start), ("Allowed", allowed)]
    middle = "".join(f'<td data-label="{label}">{escape(text) or "–"}</td>' for label, text in cells)
    return f"<tr><th><code>{escape(variable.attrib['name'])}</code></th>{middle}<td>{meaning}</td></tr>"


def _start(kind: ElementTree.Element, display_factors: dict[tuple[str, str], float]) -> str:
    """The start value in the unit that people use."""
    if "start" not in kind.attrib:
        return ""
    unit = kind.get("displayUnit") or kind.get("unit", "")
    value = float(kind.attrib["start"]) * display_factors.get((kind.get("unit", ""), unit), 1.0)
    separator = "" if unit == "deg" else " "
    return f"{value:.11g}{separator}{TYPOGRAPHY.get(unit, unit)}".strip()


def _allowed(kind: ElementTree.Element) -> str:
    """The bounds, in the unit of the Unit column."""
    low, high = kind.get("min"), kind.get("max")
    if low is not None and high is not None:
        return f"{low} … {high}"
    if low is not None:
        return f"≥ {low}"
    return f"≤ {high}" if high is not None else ""


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m frictionlab.fmu_docs.page index.html")
    try:
        Path(sys.argv[1]).write_text(page(ROOT / "modelDescription.xml"), encoding="utf-8")
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
