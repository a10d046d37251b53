"""The same scene for the reference and for the FMU: start values to Scene and back."""

from collections.abc import Mapping
from dataclasses import fields

from workshop.reference.contact import Contact
from workshop.reference.scene import Scene

_CONTACT = {f"contact.{field.name.rstrip('_')}": field.name for field in fields(Contact)}
_SCENE = {
    "V": "V",
    "d": "d",
    "E": "E",
    "F_C": "F_C",
    "friction.model": "friction",
    "vibration.f": "f",
    "vibration.V_1": "V_1",
    "vibration.a_d": "a_d",
    "vibration.phase_d": "phase_d",
    "friction.limit": "limit",
    "friction.mu": "mu",
    "friction.staticRatio": "staticRatio",
    "friction.V_S": "V_S",
    "friction.sigma_1": "sigma_1",
    "friction.sigma_2": "sigma_2",
    "contact.input": "input",
    "load": "load",
}


def scene_of(start_values: Mapping[str, float | str]) -> Scene:
    """The scene of FMU start values; what is not named has the FMU's start."""
    contact = {_CONTACT[name]: value for name, value in start_values.items() if name in _CONTACT}
    scene = {_SCENE[name]: value for name, value in start_values.items() if name in _SCENE}
    return Scene(**scene, contact=Contact(**contact))


def start_values_of(scene: Scene) -> dict[str, float | str]:
    """FMU start values of a scene; rates and start time are not among them."""
    values = {name: getattr(scene, attribute) for name, attribute in _SCENE.items()}
    values.update({name: getattr(scene.contact, attribute) for name, attribute in _CONTACT.items()})
    return values
