"""modelDescription.xml as the build needs it: its guid, and whether the C code can be what it says."""

import hashlib
import re
import uuid
from pathlib import Path

from fmpy.model_description import ModelDescription, ScalarVariable

from workshop import description

GUID_PLACEHOLDER = "{GUID}"
C_EXPRESSION = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
DERIVATIVE = re.compile(r"der\((.*)\)")


def guid_of(xml: bytes) -> str:
    """The guid of a model description that still holds the placeholder: a hash in the form of a UUID."""
    return "{" + str(uuid.UUID(bytes=hashlib.sha256(xml).digest()[:16], version=5)) + "}"


def read(path: Path) -> ModelDescription:
    """Reads it, with its guid, and checks what the C code relies on; ValueError says what breaks it."""
    xml = path.read_bytes()
    if GUID_PLACEHOLDER.encode() not in xml:
        raise ValueError(f'{path}: guid="{GUID_PLACEHOLDER}" is missing')
    model = description.read(path)
    if model.coSimulation is None or model.modelExchange is None:
        raise ValueError(f"{path}: CoSimulation or ModelExchange is missing")
    for each in model.typeDefinitions:
        values = [int(item.value) for item in each.items]
        if values != list(range(1, len(values) + 1)):
            raise ValueError(f"{path}: the values of {each.name} are {values}, not 1, 2, ...")
    for reference, variable in enumerate(model.modelVariables):
        _check_variable(path, variable, reference)
    model.guid = guid_of(xml)
    return model


def c_member(name: str) -> str:
    """The member of FcVariables that holds a variable: der.delta for der(delta), else the name."""
    return DERIVATIVE.sub(r"der.\1", name)


def _check_variable(path: Path, variable: ScalarVariable, reference: int) -> None:
    name = variable.name
    if variable.valueReference != reference:
        raise ValueError(f"{path}: valueReference of {name} must be {reference}, its place in the list")
    if not C_EXPRESSION.fullmatch(c_member(name)):
        raise ValueError(f"{path}: {name} can't be a member of the C struct")
    if variable.type not in ("Real", "Enumeration"):
        raise ValueError(f"{path}: type {variable.type} of {name} is not supported")
    if variable.type == "Real" and variable.unit is None:
        raise ValueError(f"{path}: {name} has no unit")
