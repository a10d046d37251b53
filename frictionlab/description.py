"""modelDescription.xml as plain Python values, read with Python's own library alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree


def description(xml: Path) -> dict[str, Any]:
    """Version and variables, in the order of the file.

    A variable has name, reference, causality, description and start (SI; the name of the item for an
    enumeration, None for an output); a Real has displayUnit and the factor from SI to it, an enumeration its
    items with their descriptions.
    """
    root = ElementTree.parse(xml).getroot()
    factors = {
        (unit.attrib["name"], display.attrib["name"]): float(display.get("factor", "1"))
        for unit in root.iterfind("UnitDefinitions/Unit")
        for display in unit.iterfind("DisplayUnit")
    }
    items = {
        simple_type.attrib["name"]: [
            {"name": item.attrib["name"], "description": item.get("description", "")}
            for item in simple_type.iterfind("Enumeration/Item")
        ]
        for simple_type in root.iterfind("TypeDefinitions/SimpleType")
    }
    variables = [
        _variable(element, factors, items) for element in root.iterfind("ModelVariables/ScalarVariable")
    ]
    return {"version": root.attrib["version"], "variables": variables}


def _variable(
    element: ElementTree.Element,
    factors: dict[tuple[str, str], float],
    items: dict[str, list[dict[str, str]]],
) -> dict[str, Any]:
    kind = element[0]
    variable: dict[str, Any] = {
        "name": element.attrib["name"],
        "reference": int(element.attrib["valueReference"]),
        "causality": element.get("causality", "local"),
        "description": element.get("description", ""),
        "start": None,
    }
    if kind.tag == "Enumeration":
        variable["items"] = items[kind.attrib["declaredType"]]
        variable["start"] = variable["items"][int(kind.get("start", "1")) - 1]["name"]
        return variable
    unit = kind.get("unit", "")
    variable["displayUnit"] = kind.get("displayUnit", unit)
    variable["factor"] = factors.get((unit, variable["displayUnit"]), 1.0)
    if "start" in kind.attrib:
        variable["start"] = float(kind.attrib["start"])
    return variable
