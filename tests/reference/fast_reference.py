"""hunt/reference.c from Python: the same scenes as workshop.reference takes."""

from __future__ import annotations

import ctypes
from dataclasses import fields
from functools import cache
from typing import Any

from workshop.build import build_targets
from workshop.reference.solution import Contact, Scene

NUMBERS = """start h V d E load V_rate d_rate E_rate load_rate f V_1 a_d phase_d F_C mu staticRatio V_S
    sigma_1 sigma_2 delta_0 contact_sigma stiffnessScale R_q R eta A_n nu Y c lambda""".split()
CHOICES = {
    "law": ("Dahl", "Coulomb", "ElasticPlastic", "LuGre"),
    "limit": ("Constant", "Load"),
    "contact": ("Asperities", "Constant", "Mindlin"),
    "input": ("Separation", "Load"),
}
RESULTS = """delta F_t F_t_other gap sigma F_t_mean work heat delta_start F_t_start F_t_start_other
    gap_start limit scale path largest changed panels unresolved"""


class _Scene(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_double) for name in NUMBERS),
        *((name, ctypes.c_int) for name in (*CHOICES, "initial", "binds")),
    ]


class FastStep(ctypes.Structure):
    """What ReferenceStep of hunt/reference.h holds."""

    _fields_ = [(name, ctypes.c_double) for name in RESULTS.split()]


@cache
def _library() -> Any:
    return ctypes.CDLL(str(build_targets("default", ["hunt_reference"]) / "hunt/libhunt_reference.so"))


def advance(
    scene: Scene, h: float, delta_0: float, *, settled: bool = False, binds: bool = True, fineness: int = 1
) -> FastStep:
    """One step of h [s] from scene.start and delta_0 [m], or from where delta_0 settles."""
    of_contact = {field.name: getattr(scene.contact, field.name) for field in fields(Contact)}
    values = {field.name: getattr(scene, field.name) for field in fields(Scene)} | of_contact
    values |= {
        "h": h,
        "delta_0": delta_0,
        "contact_sigma": scene.contact.sigma,
        "lambda": of_contact["lambda_"],
    }
    values |= {"law": scene.friction, "contact": scene.contact.model}
    given = _Scene(**{name: values[name] for name in NUMBERS})
    for name, choices in CHOICES.items():
        setattr(given, name, 1 + choices.index(values[name]))
    given.initial, given.binds = 1 + settled, binds
    result = FastStep()
    _library().reference_step(ctypes.byref(given), fineness, ctypes.byref(result))
    return result
