"""Seeded scenes for both interfaces, and how far a run of the FMU is from the reference."""

from __future__ import annotations

import random
from typing import Any

from solver.test_tolerance import drawn as of_any_stiffness

from frictioncontact import ModelExchange
from frictioncontact.fmu import FrictionFmu
from tools.reference import CHOICES, FIELDS, INPUTS, LAWS_WITH_A_STATE, Scene, start_values, step

OUTPUTS = 40  # points at which the host ends a step of its own
LARGEST = {"F_t": False, "F_y": False, "W_f": True, "Q_f": True}  # whether it is an energy


def drawn(number: int, planar: bool = False) -> Scene:
    """Those of tests/solver with sigma V / (2 pi f F) from 0.1 to 100, in every law with a state."""
    rng = random.Random(f"{number} {planar}")
    limit = rng.choice(CHOICES["limit"])
    now = of_any_stiffness(rng, LAWS_WITH_A_STATE[number % 3], limit, planar, kappa=(-1, 2))
    now.start = 0.0
    if not is_held(now) and (now.law == 3 or now.limit == 2):
        now.sigma_1 = 0.0  # it would not see how inputs move the bound
    return now


def is_held(now: Scene) -> bool:
    return not any(getattr(now, f"{name}_rate") for name in INPUTS)


def errors(now: Scene, found: dict[str, float]) -> dict[str, float]:
    """Of the ends, over the largest force of the step or that times the path."""
    truth = step(now)
    sizes = {name: truth.S * (truth.path if energy else 1.0) for name, energy in LARGEST.items()}
    return {name: abs(found[name] - getattr(truth, name)) / size for name, size in sizes.items()}


def error(now: Scene, found: dict[str, float]) -> float:
    return max(errors(now, found).values())


def run(now: Scene, fmu: FrictionFmu, tolerance: float) -> dict[str, float]:
    """The last outputs in a host, after an event: a bristle that slips has then been taken onto its bound."""

    def inputs(t: float, own: Any) -> dict[str, float]:
        return {FIELDS[n]: getattr(now, n) + getattr(now, f"{n}_rate") * t for n in INPUTS}

    with ModelExchange(start_values(now), inputs=inputs, tolerance=tolerance, fmu=fmu) as host:
        for k in range(1, OUTPUTS + 1):
            host.advance(now.h * k / OUTPUTS)
        host.event()
        return {name: host.get(name) for name in LARGEST}
