"""modelDescription.xml as the build needs it: with its guid, and what the compiler would not find checked."""

import hashlib
import re
import uuid
from pathlib import Path

from fmpy.model_description import ModelDescription

from tools import description
from tools.packing import initial_unknowns

GUID_PLACEHOLDER = "{GUID}"
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
    for each in model.typeDefinitions:
        values = [int(item.value) for item in each.items]
        if values != list(range(1, len(values) + 1)):
            raise ValueError(f"{path}: the values of {each.name} are {values}, not 1, 2, ...")
    for reference, variable in enumerate(model.modelVariables):
        if variable.valueReference != reference:
            raise ValueError(f"{path}: valueReference of {variable.name} must be {reference}, its place")
        if variable.type == "Real" and variable.unit is None:
            raise ValueError(f"{path}: {variable.name} has no unit")
    if initial_unknowns.renewed(xml.decode(), model) != xml.decode():
        raise ValueError(
            f"{path}: InitialUnknowns is old; python -m tools.packing.initial_unknowns writes it"
        )
    model.guid = guid_of(xml)
    return model


def c_member(name: str) -> str:
    """The member of FcVariables that holds a variable: der.delta for der(delta), else the name."""
    return DERIVATIVE.sub(r"der.\1", name)
