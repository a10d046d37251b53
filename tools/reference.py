"""hunt/reference.c by ctypes: what is right, by brute force in extended precision, with no line of the FMU.

A scene is a state of inputs and parameters over one communication step. tests/physics/test_closed_forms.py
compares the results with closed forms.
"""

from __future__ import annotations

import ctypes
import re
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

from tools.build import build_targets
from tools.description import description
from tools.project import ROOT

# The fields of a scene and their names in modelDescription.xml.
FIELDS = dict(re.findall(r"X\((\w+), ([\w.]+)\)", (ROOT / "hunt/reference.h").read_text()))
VARIABLES = {variable["name"]: variable for variable in description()["variables"]}
CHOICES = {
    name: tuple(item["name"] for item in VARIABLES[variable]["items"])
    for name, variable in FIELDS.items()
    if "items" in VARIABLES.get(variable, ())
}
RESULTS = """F_t F_y F_t_mean F_y_mean F_t_start F_y_start W_f Q_f v x slips
    delta delta_y S path""".split()
INPUTS = tuple(name for name in FIELDS if f"{name}_rate" in FIELDS)
LAWS_WITH_A_STATE = ("Dahl", "ElasticPlastic", "LuGre")
NAMES = {variable: name for name, variable in FIELDS.items()}


class Scene(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in (*FIELDS, "slips")]

    @property
    def vibrates(self) -> bool:
        return any((self.V_1, self.V_2, self.a_d))


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
    """By the reference's names; what is not named has the FMU's start."""
    return changed(library().start_values(), **values)


def changed(of: Scene, **values: Any) -> Scene:
    made = Scene.from_buffer_copy(of)
    for name, value in values.items():
        setattr(made, name, 1 + CHOICES[name].index(value) if isinstance(value, str) else value)
    return made


def scene_of(start_values: Mapping[str, Any]) -> Scene:
    """By the FMU's names. Those of the solver tell nothing."""
    return scene(**{NAMES[n]: v for n, v in start_values.items() if not n.startswith("solver.")})


def start_values(of: Scene) -> dict[str, Any]:
    """Of the FMU, but for the rates of its inputs and the choice of the start."""
    values = {n: getattr(of, name) for n, name in NAMES.items() if n in VARIABLES and name != "initial"}
    return {n: CHOICES[NAMES[n]][int(v) - 1] if NAMES[n] in CHOICES else v for n, v in values.items()}


def rest(now: Scene) -> tuple[float, float]:
    """The limit [N] and the stiffness [N/m] at the start, without vibration."""
    found = library().reference_rest(ctypes.byref(now))
    return found.limit, found.sigma


def step(now: Scene, before: Scene | None = None, fineness: int = 1) -> Any:
    """before: what the last step has left; None at the very start."""
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


def settled_deflection(now: Scene) -> float:
    """m, at the start: that of a step over no time."""
    return step(changed(now, initial="Settled", h=1e-30)).delta


def after(before: Scene, result: Any, **values: Any) -> tuple[Scene, Scene]:
    """What the step left, and the scene of the next one."""
    left = changed(before, start=before.start + before.h, slips=int(result.slips), initial="Given")
    for name in INPUTS:
        setattr(left, name, getattr(before, name) + getattr(before, f"{name}_rate") * before.h)
        setattr(left, f"{name}_rate", 0.0)
    left.delta_0, left.delta_y_0 = result.delta, result.delta_y
    left.v_0, left.x_0 = result.v, result.x
    return left, changed(left, **values)


def follow(scenes: Iterable[Scene]) -> list[Any]:
    """Step after step: the first scene says the start and the deflection. Inputs and parameters may jump."""
    found: list[Any] = []
    left = None
    for now in scenes:
        if left is not None:
            carried = ("start", "delta_0", "delta_y_0", "slips", "initial", "v_0", "x_0")
            now = changed(now, **{name: getattr(left, name) for name in carried})
        found.append(step(now, left))
        left, _ = after(now, found[-1])
    return found
