"""The same scene for the reference and for the FMU: start values to Scene and back."""

from collections.abc import Mapping
from dataclasses import fields

from workshop.reference.contact import Contact
from workshop.reference.scene import Scene

_CONTACT = {f"contact.{field.name.rstrip('_')}": field.name for field in fields(Contact)}
_NAMES = """
    V d E load F_C vibration.f vibration.V_1 vibration.a_d vibration.phase_d contact.input friction.model
    friction.limit friction.mu friction.staticRatio friction.V_S friction.sigma_1 friction.sigma_2
""".split()
_SCENE = {name: name.rpartition(".")[2] for name in _NAMES} | {"friction.model": "friction"}


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
