"""modelDescription.xml as the build reads it: its variables, its log categories and its guid."""

from __future__ import annotations

import hashlib
import re
import uuid
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

GUID_PLACEHOLDER = "{GUID}"
C_EXPRESSION = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")


@dataclass(frozen=True)
class Variable:
    name: str
    kind: str  # Real or Enumeration
    unit: str
    causality: str
    variability: str
    start: float | None
    min: float | None
    max: float | None
    declared_type: str


@dataclass(frozen=True)
class ModelDescription:
    guid: str
    model_identifier: str
    variables: list[Variable]
    enumerations: dict[str, list[str]]  # type name: names of the values 1, 2, ...
    log_categories: list[str]


def guid_of(xml: bytes) -> str:
    """The guid of a model description that still holds the placeholder: a hash in the form of a UUID."""
    return "{" + str(uuid.UUID(bytes=hashlib.sha256(xml).digest()[:16], version=5)) + "}"


def read(path: Path) -> ModelDescription:
    """Reads and checks what the C code relies on; ValueError says what breaks it."""
    xml = path.read_bytes()
    if xml.count(GUID_PLACEHOLDER.encode()) < 1:
        raise ValueError(f'{path}: guid="{GUID_PLACEHOLDER}" is missing')
    root = ElementTree.fromstring(xml)
    co_simulation = root.find("CoSimulation")
    if co_simulation is None:
        raise ValueError(f"{path}: CoSimulation is missing")
    enumerations = {
        simple_type.attrib["name"]: _literals(path, simple_type)
        for simple_type in root.iterfind("TypeDefinitions/SimpleType[Enumeration]")
    }
    variables = [
        _variable(path, element, reference, enumerations)
        for reference, element in enumerate(root.iterfind("ModelVariables/ScalarVariable"))
    ]
    return ModelDescription(
        guid=guid_of(xml),
        model_identifier=co_simulation.attrib["modelIdentifier"],
        variables=variables,
        enumerations=enumerations,
        log_categories=[category.attrib["name"] for category in root.iterfind("LogCategories/Category")],
    )


def _literals(path: Path, simple_type: ElementTree.Element) -> list[str]:
    items = simple_type.findall("Enumeration/Item")
    values = [int(item.attrib["value"]) for item in items]
    if values != list(range(1, len(values) + 1)):
        raise ValueError(f"{path}: the values of {simple_type.attrib['name']} are {values}, not 1, 2, ...")
    return [item.attrib["name"] for item in items]


def _variable(
    path: Path, element: ElementTree.Element, reference: int, enumerations: dict[str, list[str]]
) -> Variable:
    name = element.attrib["name"]
    if int(element.attrib["valueReference"]) != reference:
        raise ValueError(f"{path}: valueReference of {name} must be {reference}, its place in the list")
    if not C_EXPRESSION.fullmatch(name):
        raise ValueError(f"{path}: {name} can't be a member of the C struct")
    typed = next(iter(element))
    if typed.tag not in ("Real", "Enumeration"):
        raise ValueError(f"{path}: type {typed.tag} of {name} is not supported")
    declared_type = typed.get("declaredType", "")
    minimum, maximum = _number(typed, "min"), _number(typed, "max")
    if typed.tag == "Enumeration":
        minimum, maximum = 1.0, float(len(enumerations[declared_type]))
    elif "unit" not in typed.attrib:
        raise ValueError(f"{path}: {name} has no unit")
    return Variable(
        name=name,
        kind=typed.tag,
        unit=typed.get("unit", ""),
        causality=element.attrib["causality"],
        variability=element.attrib["variability"],
        start=_number(typed, "start"),
        min=minimum,
        max=maximum,
        declared_type=declared_type,
    )


def _number(element: ElementTree.Element, attribute: str) -> float | None:
    text = element.get(attribute)
    return None if text is None else float(text)
