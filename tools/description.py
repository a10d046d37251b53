"""modelDescription.xml as FMPy reads it, and as plain values for pages."""

from pathlib import Path
from typing import Any

from fmpy.model_description import ModelDescription, ScalarVariable, read_model_description

from frictioncontact.values import Value, Variables
from tools.project import ROOT

XML = ROOT / "modelDescription.xml"


def read(xml: Path = XML) -> ModelDescription:
    """Of a file, or of the folder of an unzipped FMU."""
    return read_model_description(str(xml), validate=False)


def display_unit(model: ModelDescription, variable: ScalarVariable) -> tuple[str, float]:
    """The unit that people use for a Real, and the factor to it from SI."""
    own = variable.unit or ""
    name = variable.displayUnit or own
    return name, Variables(model).factors.get((own, name), 1.0)


def description(xml: Path = XML) -> dict[str, Any]:
    """Version and variables, in the order of the file.

    A variable has name, reference, causality, variability, description and start (SI; the name of the item
    for an enumeration, None for an output); a Real has displayUnit and the factor from SI to it, an
    enumeration its items with their descriptions.
    """
    model = read(xml)
    starts = Variables(model).starts()
    variables = [_plain(model, variable, starts.get(variable.name)) for variable in model.modelVariables]
    return {"version": model.version, "variables": variables}


def _plain(model: ModelDescription, variable: ScalarVariable, start: Value | None) -> dict[str, Any]:
    plain: dict[str, Any] = {
        "name": variable.name,
        "reference": variable.valueReference,
        "causality": variable.causality,
        "variability": variable.variability,
        "description": variable.description or "",
        "start": start,
    }
    if variable.type == "Enumeration":
        items = variable.declaredType.items
        plain["items"] = [{"name": item.name, "description": item.description or ""} for item in items]
    else:
        plain["displayUnit"], plain["factor"] = display_unit(model, variable)
    return plain
