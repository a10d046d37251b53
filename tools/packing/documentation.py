"""The documentation inside the FMU: documentation/index.html, documentation/licenses/ and model.png.

    python -m tools.packing.documentation index.html        writes the page

The page is docs/fmu/page.html with the plots of docs/fmu/ and tables of the variables of
modelDescription.xml put in. The build makes the page.
"""

import sys
from html import escape
from pathlib import Path

from fmpy.model_description import ModelDescription, ScalarVariable

from tools import description
from tools.project import ROOT

FMU_DOCS = ROOT / "docs" / "fmu"
PLOTS = ("force", "mean")
CAUSALITIES = {
    "input": "Inputs",
    "output": "Outputs",
    "parameter": "Parameters",
    "local": "Local variables",
    "independent": "Independent variable",
}
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


def page(xml: Path = description.XML, playground: bool = False) -> str:
    """The text of index.html; with a link to the page of the live FMU if that lies beside it."""
    model = description.read(xml)
    text = (FMU_DOCS / "page.html").read_text(encoding="utf-8")
    parts = {"variables": variable_tables(model), "version": escape(model.version)}
    parts |= {f"plot_{name}": (FMU_DOCS / f"{name}.svg").read_text(encoding="utf-8") for name in PLOTS}
    parts["playground"] = '<a href="playground.html">Try it live</a>' if playground else ""
    for name, part in parts.items():
        placeholder = f"<!-- {name} -->"
        if text.count(placeholder) != 1:
            raise ValueError(f"page.html must hold {placeholder} once")
        text = text.replace(placeholder, part.strip())
    return text


def variable_tables(model: ModelDescription) -> str:
    """One table for each causality, in the order of the model description."""
    head = "".join(f"<th>{word}</th>" for word in ("Name", "Unit", "Start", "Allowed", "Meaning"))
    tables = []
    for causality, title in CAUSALITIES.items():
        rows = [_row(model, variable) for variable in model.modelVariables if variable.causality == causality]
        if rows:
            tables += [f"<h3>{title}</h3>", "<table>", f"<thead><tr>{head}</tr></thead>", "<tbody>"]
            tables += [*rows, "</tbody>", "</table>"]
    return "\n".join(tables)


def _row(model: ModelDescription, variable: ScalarVariable) -> str:
    meaning = escape(variable.description or "")
    if variable.variability == "tunable":
        meaning += ' <span class="tag">tunable</span>'
    if variable.type == "Enumeration":
        items = variable.declaredType.items
        unit, start = "", items[int(variable.start or "1") - 1].name
        allowed = f"{items[0].value} … {items[-1].value}"
        entry = "<li><code>{}</code> {}: {}</li>".format
        options = (entry(x.value, escape(x.name), escape(x.description or "")) for x in items)
        meaning += f"<ul>{''.join(options)}</ul>"
    else:
        unit, start, allowed = variable.unit or "", _start(model, variable), _allowed(variable)
    cells = [("Unit", TYPOGRAPHY.get(unit, unit)), ("Start", start), ("Allowed", allowed)]
    middle = "".join(f'<td data-label="{label}">{escape(text) or "–"}</td>' for label, text in cells)
    return f"<tr><th><code>{escape(variable.name)}</code></th>{middle}<td>{meaning}</td></tr>"


def _start(model: ModelDescription, variable: ScalarVariable) -> str:
    """The start value in the unit that people use."""
    if variable.start is None:
        return ""
    unit, factor = description.display_unit(model, variable)
    value = float(variable.start) * factor
    separator = "" if unit == "deg" else " "
    return f"{value:.11g}{separator}{TYPOGRAPHY.get(unit, unit)}".strip()


def _allowed(variable: ScalarVariable) -> str:
    """The bounds, in the unit of the Unit column."""
    low, high = variable.min, variable.max
    if low is not None:
        return f"≥ {low}" if high is None else f"{low} … {high}"
    return "" if high is None else f"≤ {high}"


if __name__ == "__main__":
    try:
        Path(sys.argv[1]).write_text(page(), encoding="utf-8")
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
