"""Seeded scenes for model exchange, and how far a run of the FMU in a host is from the reference.

PYTHONPATH=tests .venv/bin/python -m model_exchange.exchange_scenes --scenes 500     prints the errors
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from reference.fast_reference import advance

from frictioncontact.fmu import FrictionFmu, Value
from workshop.build import build_fmu
from workshop.exchange import Host
from workshop.reference.solution import Contact, Scene
from workshop.reference.start_values import start_values_of

LAWS = ("Dahl", "LuGre", "ElasticPlastic")
F, MU, LOAD, FREQUENCY = 55.0, 0.176, 312.0, 20e3
OUTPUTS = 40  # points at which the host ends a step of its own
FINER = 100.0  # the tolerance over the one that shows whose an error is


@dataclass(frozen=True)
class ExchangeScene:
    number: int
    scene: Scene
    delta_0: float  # m
    h: float  # s

    def start_values(self) -> dict[str, Value]:
        return {**start_values_of(self.scene), "delta_0": self.delta_0}

    def inputs(self, t: float) -> dict[str, float]:
        names = ("V", "d", "E", "load")
        return {n: getattr(self.scene, n) + getattr(self.scene, f"{n}_rate") * t for n in names}

    @property
    def is_held(self) -> bool:
        return all(getattr(self.scene, f"{name}_rate") == 0.0 for name in ("V", "d", "E", "load"))

    @property
    def inputs_move_a_bound(self) -> bool:
        scene = self.scene
        bounded = scene.friction == "ElasticPlastic" or scene.limit == "Load"
        by_V = scene.friction == "ElasticPlastic" and scene.staticRatio > 1.0 and scene.V_rate != 0.0
        return bounded and (by_V or scene.d_rate != 0.0 or scene.E_rate != 0.0 or scene.load_rate != 0.0)


class Errors(NamedTuple):
    F_t: float  # over the limit of the friction
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


def errors(scene: ExchangeScene, values: Mapping[str, float]) -> Errors:
    """Of F_t, W_f and Q_f at the end."""
    truth = advance(scene.scene, scene.h, scene.delta_0)
    energy = truth.limit * truth.path
    low, high = sorted((truth.F_t, truth.F_t_other))  # F_t has two values where V jumps through zero
    F_t = values["F_t"]
    return Errors(
        abs(min(max(F_t, low), high) - F_t) / truth.limit,
        abs(values["W_f"] - truth.work) / energy,
        abs(values["Q_f"] - truth.heat) / energy,
    )


def run(scene: ExchangeScene, fmu: FrictionFmu, tolerance: float) -> dict[str, float]:
    """The last outputs, after an event: a bristle that slips has then been taken onto its bound."""
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


def print_host_share(coarse: np.ndarray, fine: np.ndarray, tolerance: float) -> None:
    """An error of the host's integrator falls with its tolerance; that of an event unseen stays."""
    large = coarse > 3 * tolerance
    ratios = coarse[large] / np.maximum(fine[large], 1e-16)
    print(f"tolerance / {FINER:g}: errors above 3 tolerances fall by a median of {np.median(ratios):.0f}")
    for i in np.flatnonzero((large & (fine > coarse * 3 / FINER**0.5)).any(1)):
        print(f"scene {i} keeps F_t {fine[i][0]:.1e}, W_f {fine[i][1]:.1e}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--tolerance", type=float, default=1e-7)
    chosen = parser.parse_args()
    found: dict[tuple[str, bool], list[Errors]] = {}
    coarse, fine = [], []
    with FrictionFmu(build_fmu()) as fmu:
        for number in range(chosen.scenes):
            scene = drawn(number, fmu)
            one, finer = (
                errors(scene, run(scene, fmu, tolerance))
                for tolerance in (chosen.tolerance, chosen.tolerance / FINER)
            )
            found.setdefault((scene.scene.friction, scene.inputs_move_a_bound), []).append(one)
            coarse.append(one[:2])
            fine.append(finer[:2])
    print(f"host's tolerance {chosen.tolerance:g}; errors over it: largest, median")
    for (law, moved), all_errors in sorted(found.items()):
        of = np.array(all_errors) / chosen.tolerance
        what = "inputs move its bound" if moved else ""
        cells = "  ".join(
            f"{name} {largest:8.3g} {median:8.3g}"
            for name, largest, median in zip(Errors._fields, of.max(0), np.median(of, 0), strict=True)
        )
        print(f"{law:15}{len(of):4} scenes  {cells}  {what}")
    print_host_share(np.array(coarse), np.array(fine), chosen.tolerance)


if __name__ == "__main__":
    main()
