"""Seeded scenes for both interfaces, and how far a run of the FMU is from the reference."""

from __future__ import annotations

from typing import Any

import numpy as np

from frictioncontact.fmu import FrictionFmu, Value
from workshop.exchange import Host
from workshop.reference import INPUTS, Scene, changed, rest, scene, start_values, step

LAWS = ("Dahl", "LuGre", "ElasticPlastic")
FREQUENCY = 20e3
OUTPUTS = 40  # points at which the host ends a step of its own
LARGEST = {"F_t": False, "F_y": False, "W_f": True, "Q_f": True}  # whether it is an energy


def drawn(number: int, planar: bool = False) -> Scene:
    """sigma V / (2 pi f F) from 0.1 to 100, every law, limit and contact; most vibrate, most inputs move."""
    rng = np.random.default_rng([29, number, planar])
    chance = lambda p: bool(rng.random() < p)  # noqa: E731
    law, limit = LAWS[number % 3], rng.choice(["Constant", "Load"]).item()
    moves, pressed = chance(0.6), chance(0.5)
    damped = chance(0.4) and not (moves and (law == "ElasticPlastic" or limit == "Load"))
    now = scene(
        law=law,
        limit=limit,
        contact=rng.choice(["Asperities", "Constant", "Mindlin"]).item(),
        input="Load" if pressed else "Separation",
        h=rng.uniform(0.3, 2.5) / FREQUENCY,
        f=FREQUENCY,
        V=rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(-2, 0),
        V_1=10 ** rng.uniform(-2, 0.3) if chance(0.6) else 0.0,
        a_d=10 ** rng.uniform(-7.5, -6) if chance(0.5) else 0.0,
        phase_d=rng.uniform(0, 2 * np.pi),
        d=rng.uniform(10e-6, 18e-6),
        staticRatio=rng.uniform(1, 2) if chance(0.5) else 1.0,
        V_S=10 ** rng.uniform(-2, 0),
    )
    if planar:
        now.V_y, now.phase_2 = rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(-2, 0), rng.uniform(0, 2 * np.pi)
        now.V_2 = 10 ** rng.uniform(-2, 0.3) if chance(0.6) else 0.0
    speed = max(abs(now.V), now.V_1, abs(now.V_y), now.V_2)
    # the damping would not see how inputs move the bound
    now.sigma_1 = rng.uniform(0, 0.02) * now.F_C / speed if damped else 0.0
    now.sigma_2 = rng.uniform(0, 0.1) * now.F_C / speed if chance(0.4) else 0.0
    if moves:
        now.V_rate, now.V_y_rate = rng.uniform(-2, 2) * now.V / now.h, rng.uniform(-2, 2) * now.V_y / now.h
        now.load_rate = rng.uniform(-0.5, 0.5) * now.load / now.h if pressed else 0.0
        now.d_rate = 0.0 if pressed else rng.uniform(-0.3e-6, 0.3e-6) / now.h
        now.E_rate = rng.uniform(-0.1, 0.1) * now.E / now.h if chance(0.3) else 0.0
    stiffness = 10 ** rng.uniform(-1, 2) * now.F_C * 2 * np.pi * FREQUENCY / speed
    now.contact_sigma, now.stiffnessScale = stiffness, stiffness / rest(changed(now, stiffnessScale=1.0))[1]
    size, angle = rng.uniform(0, 0.9) * rest(now)[0] / stiffness, rng.uniform(0, 2 * np.pi)
    now.delta_0 = size * np.cos(angle)
    now.delta_y_0 = size * np.sin(angle) if planar else 0.0
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


def stepped(now: Scene, fmu: FrictionFmu, settings: dict[str, Value]) -> dict[str, float]:
    """Outputs after one step of co-simulation."""
    with fmu.session(start_values(now) | settings) as session:
        session.set_rates(**{name: getattr(now, f"{name}_rate") for name in INPUTS})
        session.step(now.h)
        return dict(zip(LARGEST, session.read(LARGEST), strict=True))


def run(now: Scene, fmu: FrictionFmu, tolerance: float) -> dict[str, float]:
    """The last outputs in a host, after an event: a bristle that slips has then been taken onto its bound."""

    def inputs(t: float, own: Any) -> dict[str, float]:
        return {name: getattr(now, name) + getattr(now, f"{name}_rate") * t for name in INPUTS}

    with Host(fmu, start_values(now), inputs, tolerance=tolerance, longest_step=now.h / 20) as host:
        for k in range(1, OUTPUTS + 1):
            host.advance(now.h * k / OUTPUTS)
        host.event()
        return dict(zip(LARGEST, host.get(*LARGEST), strict=True))
