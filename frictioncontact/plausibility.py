"""Scenes that were hardly meant: settings that nothing uses, and magnitudes of another unit."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from frictioncontact.errors import is_quiet, warn
from frictioncontact.values import Variables

BRISTLES = ("Dahl", "ElasticPlastic", "LuGre")
WITH_STATIC_FRICTION = ("ElasticPlastic", "LuGre")
FIXED_STEPS = ("backwardEuler", "trapezoid", "rk4", "explicitEuler")
# A setting, the variables that decide whether it is used, and the items with which it is used; None: any
# value but the start value, and a decider that the scene gives was switched off on purpose.
USED = (
    ("load", "contact.input", ("Load",)),
    ("d", "contact.input", ("Separation",)),
    ("contact.sigma", "contact.model", ("Constant",)),
    ("contact.stiffnessScale", "contact.model", ("Asperities", "Mindlin")),
    ("F_C", "friction.limit", ("Constant",)),
    ("friction.mu", "friction.limit", ("Load",)),
    ("friction.staticRatio", "friction.model", WITH_STATIC_FRICTION),
    ("friction.V_S", "friction.model", WITH_STATIC_FRICTION),
    ("friction.V_S", "friction.staticRatio", None),
    ("friction.sigma_1", "friction.model", BRISTLES),
    ("delta_0", "friction.model", BRISTLES),
    ("delta_y_0", "friction.model", BRISTLES),
    ("solver.stepSize", "solver.method", FIXED_STEPS),
    ("vibration.phase_d", "vibration.a_d", None),
    ("vibration.phase_2", "vibration.V_2", None),
    ("body.F", "body.m", None),
    ("body.v_0", "body.m", None),
    ("body.x_0", "body.m", None),
    ("vibration.f", "vibration.V_1 vibration.V_2 vibration.a_d", None),
)
# Magnitudes [SI] from which to which a value is a likely one; 0 always is.
LIKELY = {
    "V": (0.0, 100.0),
    "V_y": (0.0, 100.0),
    "d": (1e-9, 1e-3),
    "E": (3e5, 1e13),
    "delta_0": (0.0, 1e-2),
    "delta_y_0": (0.0, 1e-2),
    "body.m": (1e-6, 1e6),
    "body.v_0": (0.0, 100.0),
    "contact.sigma": (100.0, 1e15),
    "contact.R_q": (1e-10, 1e-3),
    "contact.R": (1e-9, 1e-1),
    "contact.A_n": (0.0, 10.0),
    "contact.Y": (1e5, 1e12),
    "friction.mu": (0.0, 10.0),
    "friction.V_S": (0.0, 10.0),
    "vibration.f": (100.0, 1e8),
    "vibration.V_1": (1e-5, 100.0),
    "vibration.V_2": (1e-5, 100.0),
    "vibration.a_d": (0.0, 1e-3),
    "vibration.phase_d": (0.0, 15.0),
    "vibration.phase_2": (0.0, 15.0),
}


def unused(known: Variables, given: Mapping[str, np.ndarray]) -> dict[str, str]:
    """Settings that no scene uses, and why. given: values by name, of enumerations the items' numbers."""
    found = {}
    for setting, deciders, items in USED:
        if setting not in given or (given[setting] == float(known.all[setting].start)).all():
            continue
        if items is None:
            names = deciders.split()
            if not any(name in given for name in names):
                starts = " and ".join(f"{name} = {known.all[name].start}" for name in names)
                found[setting] = f"{setting} has no effect: {starts}"
            continue
        numbers = given.get(deciders, np.array(float(known.all[deciders].start)))
        if not np.isin(numbers, [known.items[deciders][item] for item in items]).any():
            now = known.named(deciders, float(numbers.flat[0]))
            needed = " or ".join(items)
            found[setting] = f"{setting} has no effect: {deciders} = {now}; it is used with {needed}"
    return found


def unlikely(known: Variables, given: Mapping[str, np.ndarray]) -> list[str]:
    """Magnitudes that look like another unit."""
    found = []
    for name, (low, high) in LIKELY.items():
        if name not in given:
            continue
        size = np.abs(given[name])
        odd = (size != 0.0) & ((size < low) | (size > high))
        if odd.any():
            value = float(given[name].flat[int(np.argmax(odd))])
            unit = "" if known.all[name].unit == "1" else f" {known.all[name].unit}"
            found.append(f"{name} = {value:g}{unit} is an unlikely magnitude{_display(known, name, value)}")
    return found


def _display(known: Variables, name: str, value: float) -> str:
    """The same number in the unit that the variable is shown in, if that may have been meant."""
    unit = known.all[name].displayUnit
    factor = known.factors.get((known.all[name].unit, unit))
    low, high = LIKELY[name]
    if not factor or abs(value) < 1.0 or not low <= abs(value / factor) <= high:
        return ""
    return f": {value:g} {unit} is {value / factor:.6g} here"


def warn_of(
    known: Variables, scene: Mapping[str, Any], log: Sequence[str] = (), is_over_period: bool = False
) -> None:
    """Warns of scenes with these values, and of what the FMU logged, at the line of the user.

    scene: names and values, which are valid; arrays stand for many scenarios. is_over_period: vibration.f
    says how long they are.
    """
    if is_quiet():
        return
    given = {name: np.atleast_1d(known.numbers(name, value, name)) for name, value in scene.items()}
    idle = unused(known, given)
    if is_over_period:
        idle.pop("vibration.f", None)
    said = [*idle.values(), *unlikely(known, given)]
    names = {text.split(" ", 1)[0] for text in said}  # of which the FMU's own words are left out
    warn([*said, *(text for text in log if not names & set(re.findall(r"[\w.]+", text)))])
