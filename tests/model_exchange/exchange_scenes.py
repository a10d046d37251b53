"""Seeded scenes for both interfaces, and how far a run of the FMU is from the reference."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from physics.course import Step

from frictioncontact.fmu import FrictionFmu, Value
from workshop.exchange import Host
from workshop.reference.contact import Contact
from workshop.reference.scene import Scene
from workshop.reference.start_values import start_values_of

LAWS = ("Dahl", "LuGre", "ElasticPlastic")
F, MU, LOAD, FREQUENCY = 55.0, 0.176, 312.0, 20e3
INPUTS = ("V", "d", "E", "load")
OUTPUTS = 40  # points at which the host ends a step of its own


@dataclass(frozen=True)
class ExchangeScene:
    number: int
    scene: Scene
    delta_0: float  # m
    h: float  # s

    def start_values(self) -> dict[str, Value]:
        return {**start_values_of(self.scene), "delta_0": self.delta_0}

    def inputs(self, t: float) -> dict[str, float]:
        return {n: getattr(self.scene, n) + getattr(self.scene, f"{n}_rate") * t for n in INPUTS}

    @property
    def is_held(self) -> bool:
        return all(getattr(self.scene, f"{name}_rate") == 0.0 for name in INPUTS)


class Errors(NamedTuple):
    F_t: float  # over the largest force of the step
    W_f: float  # over that times the path
    Q_f: float


def drawn(number: int, fmu: FrictionFmu) -> ExchangeScene:
    """sigma V / (2 pi f F) from 0.1 to 100, every law, limit and contact; most vibrate, most inputs move."""
    rng = np.random.default_rng([29, number])
    chance = lambda p: bool(rng.random() < p)  # noqa: E731
    law = LAWS[number % 3]
    h = rng.uniform(0.3, 3.0) / FREQUENCY
    V = rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(-2, 0)
    V_1 = 10 ** rng.uniform(-2, 0.3) if chance(0.6) else 0.0
    a_d = 10 ** rng.uniform(-7.5, -6) if chance(0.5) else 0.0
    moves = chance(0.67)
    pressed = chance(0.5)
    speed = max(abs(V), V_1)
    stiffness = 10 ** rng.uniform(-1, 2) * F * 2 * np.pi * FREQUENCY / speed
    E = 58.556936170e9
    limit = rng.choice(["Constant", "Load"]).item()
    bounded = law == "ElasticPlastic" or limit == "Load"
    damped = chance(0.4) and not (moves and bounded)  # the damping would not see how inputs move the bound
    scene = Scene(
        V=V,
        d=rng.uniform(10e-6, 18e-6),
        E=E,
        load=LOAD,
        f=FREQUENCY,
        V_1=V_1,
        a_d=a_d,
        phase_d=rng.uniform(0, 2 * np.pi),
        F_C=F,
        mu=MU,
        friction=law,
        limit=limit,
        input="Load" if pressed else "Separation",
        staticRatio=rng.uniform(1, 2) if chance(0.5) else 1.0,
        V_S=10 ** rng.uniform(-2, 0),
        sigma_1=rng.uniform(0, 0.02) * F / speed if damped else 0.0,
        sigma_2=rng.uniform(0, 0.1) * F / speed if chance(0.4) else 0.0,
        V_rate=rng.uniform(-2, 2) * V / h if moves and chance(0.7) else 0.0,
        d_rate=rng.uniform(-0.3e-6, 0.3e-6) / h if moves and chance(0.6) and not pressed else 0.0,
        load_rate=rng.uniform(-0.5, 0.5) * LOAD / h if moves and chance(0.6) and pressed else 0.0,
        E_rate=rng.uniform(-0.1, 0.1) * E / h if moves and chance(0.3) else 0.0,
        contact=Contact(model=rng.choice(["Asperities", "Constant", "Mindlin"]).item(), sigma=stiffness),
    )
    with Host(fmu, start_values_of(scene), lambda t, own: {}, tolerance=1e-3) as host:
        sigma, F_n = host.get("sigma", "F_n")
    if scene.contact.model != "Constant":
        scene = replace(scene, contact=replace(scene.contact, stiffnessScale=stiffness / sigma))
    bound = (F if limit == "Constant" else MU * F_n) / stiffness
    return ExchangeScene(number, scene, rng.uniform(-0.9, 0.9) * bound, h)


def errors(truth: Step, values: Mapping[str, float]) -> Errors:
    """Of F_t, W_f and Q_f at the end."""
    return Errors(
        abs(float(truth.F_t) - values["F_t"]) / truth.scale,
        abs(float(truth.W_f) - values["W_f"]) / (truth.scale * truth.path),
        abs(float(truth.Q_f) - values["Q_f"]) / (truth.scale * truth.path),
    )


def stepped(scene: ExchangeScene, fmu: FrictionFmu, settings: dict[str, Value]) -> dict[str, float]:
    """Outputs after one step of co-simulation."""
    rates = {name: getattr(scene.scene, f"{name}_rate") for name in INPUTS}
    names = ("F_t", "W_f", "Q_f")
    with fmu.session(scene.start_values() | settings) as session:
        session.set_rates(**{name: rate for name, rate in rates.items() if rate})
        session.step(scene.h)
        return dict(zip(names, session.read(names), strict=True))


def run(scene: ExchangeScene, fmu: FrictionFmu, tolerance: float) -> dict[str, float]:
    """The last outputs in a host, after an event: a bristle that slips has then been taken onto its bound."""
    with Host(
        fmu,
        scene.start_values(),
        lambda t, own: scene.inputs(t),
        tolerance=tolerance,
        longest_step=scene.h / 20,
    ) as host:
        for k in range(1, OUTPUTS + 1):
            host.advance(scene.h * k / OUTPUTS)
        host.event()
        names = ("F_t", "W_f", "Q_f", "solver.evaluations")
        return {**dict(zip(names, host.get(*names), strict=True)), "events": host.events}
