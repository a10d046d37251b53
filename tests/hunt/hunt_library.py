"""The reference of hunt/ by ctypes: scenes by name, steps and settled forces."""

from __future__ import annotations

import ctypes
import re
from functools import cache
from typing import Any

from workshop.build import build_targets
from workshop.description import description
from workshop.project import ROOT

# The fields of a scene and their names in modelDescription.xml.
FIELDS = dict(re.findall(r"X\((\w+), ([\w.]+)\)", (ROOT / "hunt/reference.h").read_text()))
VARIABLES = {variable["name"]: variable for variable in description()["variables"]}
CHOICES = {
    name: tuple(item["name"] for item in VARIABLES[variable]["items"])
    for name, variable in FIELDS.items()
    if "items" in VARIABLES.get(variable, ())
}
RESULTS = """F_t F_y F_t_mean F_y_mean F_t_start F_y_start work heat slips
    delta delta_y S path""".split()
LAWS_WITH_A_STATE = ("Dahl", "ElasticPlastic", "LuGre")


class Scene(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in (*FIELDS, "slips")]


class Step(ctypes.Structure):
    _fields_ = [*((name, ctypes.c_double) for name in RESULTS), ("known", ctypes.c_bool)]


class Rest(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in ("d", "limit", "sigma")]


@cache
def library() -> Any:
    found = ctypes.CDLL(str(build_targets("default", ["hunt_reference"]) / "hunt/libhunt_reference.so"))
    found.start_values.restype = Scene
    found.reference_rest.restype = Rest
    found.reference_settled_force.restype = ctypes.c_bool
    return found


def scene(**values: Any) -> Scene:
    made = library().start_values()
    for name, value in values.items():
        setattr(made, name, 1 + CHOICES[name].index(value) if name in CHOICES else value)
    return made


def start_values(of: Scene) -> dict[str, Any]:
    """Of the FMU, but for the rates of its inputs and the choice of the start."""
    names = {
        name: variable for name, variable in FIELDS.items() if variable in VARIABLES and name != "initial"
    }
    return {
        variable: int(getattr(of, name)) if name in CHOICES else getattr(of, name)
        for name, variable in names.items()
    }


def rest(now: Scene) -> tuple[float, float]:
    """The limit [N] and the stiffness [N/m] at the start, without vibration."""
    found = library().reference_rest(ctypes.byref(now))
    return found.limit, found.sigma


def step(now: Scene, before: Scene | None = None, fineness: int = 1) -> Any:
    result = Step()
    past = ctypes.byref(before) if before is not None else None
    library().reference_step(past, ctypes.byref(now), fineness, ctypes.byref(result))
    assert result.known
    return result


def settled(now: Scene) -> tuple[float, float]:
    """F_t_settled and F_y_settled [N]."""
    force, S = (ctypes.c_double * 2)(), ctypes.c_double()
    assert library().reference_settled_force(ctypes.byref(now), force, ctypes.byref(S))
    return force[0], force[1]


def after(before: Scene, result: Any, **values: Any) -> tuple[Scene, Scene]:
    """What the step left, and the scene of the next one."""
    left = Scene.from_buffer_copy(before)
    left.start += before.h
    for name in ("V", "d", "E", "load", "V_y"):
        setattr(left, name, getattr(before, name) + getattr(before, f"{name}_rate") * before.h)
        setattr(left, f"{name}_rate", 0.0)
    left.delta_0, left.delta_y_0 = result.delta, result.delta_y
    left.slips, left.initial = int(result.slips), 1
    now = Scene.from_buffer_copy(left)
    for name, value in values.items():
        setattr(now, name, value)
    return left, now
