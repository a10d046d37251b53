"""Scenes whose cost tells whether the step control works, and their committed numbers of evaluations.

    PYTHONPATH=tests .venv/bin/python tests/solver/step_control.py

counts them anew on the built FMU and writes step_control.csv. The accuracy tests say whether results are
right; these numbers say what they cost, for a spoilt step control often costs work and no accuracy.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from frictioncontact.fmu import FrictionFmu, Value
from tools.project import ROOT

TABLE = Path(__file__).with_suffix(".csv")
PERIOD = 1.0 / 20e3
SLIDER: dict[str, Value] = {"V": 0.005, "vibration.V_1": 1.44}
MOVING: dict[str, Value] = SLIDER | {"vibration.a_d": 1.1e-6, "vibration.phase_d": 0.7}
ELASTIC_PLASTIC: dict[str, Value] = {"friction.model": "ElasticPlastic"}
LUGRE: dict[str, Value] = {"friction.model": "LuGre", "friction.staticRatio": 1.3}
PRESSED: dict[str, Value] = {"friction.limit": "Load", "contact.input": "Load"}
CONSTANT: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 5e5}


@dataclass(frozen=True)
class Scene:
    start: Mapping[str, Value]
    h: float  # s
    steps: int = 1
    rates: Mapping[str, float] = field(default_factory=dict)  # of the inputs, per second


def scaled(scale: float) -> dict[str, Value]:
    return {"contact.stiffnessScale": scale}


SCENES = {
    "stiff": Scene(MOVING, PERIOD),
    "settled, small steps": Scene(MOVING | {"V": 0.5, "vibration.V_1": 0.3} | scaled(1e-4), PERIOD / 50, 200),
    "a dip with V > V_1": Scene(SLIDER | {"V": 1.4401} | scaled(1e-2), 1.3 * PERIOD, 10),
    "a_d near d": Scene(SLIDER | {"vibration.a_d": 13.9e-6} | scaled(1e-6), PERIOD),
    "tolerance 1e-3": Scene(MOVING | {"solver.tolerance": 1e-3}, 7.7 * PERIOD),
    "inputs that move": Scene(MOVING | scaled(1e-5), 5.5 * PERIOD, 3, {"V": -40.0, "d": 2e-3}),
    "moving periods, of which some are not leapt over": Scene(
        ELASTIC_PLASTIC | CONSTANT | {"V": 0.05, "vibration.V_1": 0.17}, 300 * PERIOD, rates={"V": -3.0}
    ),
    "the limit and the surfaces follow a load": Scene(
        MOVING | LUGRE | PRESSED | {"friction.staticRatio": 1.4} | scaled(1e-4), 2.2 * PERIOD, 2
    ),
    "ElasticPlastic, limit and stiffness move": Scene(
        MOVING | ELASTIC_PLASTIC | {"friction.limit": "Load"}, 1.3 * PERIOD, 10
    ),
    "bells of the Stribeck curve, in layers": Scene(
        MOVING | LUGRE | {"friction.V_S": 0.0144} | scaled(1e-4), 0.93 * PERIOD, 10
    ),
    "cvode": Scene(MOVING | scaled(1e-6) | {"solver.method": "cvode"}, PERIOD),
}


def evaluations(fmu: FrictionFmu, scene: Scene) -> float:
    """Of the equation, over all steps of the scene."""
    with fmu.session(scene.start) as session:
        for _ in range(scene.steps):
            if scene.rates:
                session.set_rates(**scene.rates)
            session.step(scene.h)
        return session.get("solver.evaluations")


def committed() -> dict[str, float]:
    with TABLE.open(newline="") as rows:
        return {row["scene"]: float(row["evaluations"]) for row in csv.DictReader(rows)}


def main() -> None:
    with FrictionFmu(ROOT / "build" / "FrictionContact.fmu") as fmu, TABLE.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("scene", "evaluations"))
        writer.writerows((name, f"{evaluations(fmu, scene):g}") for name, scene in SCENES.items())


if __name__ == "__main__":
    main()
