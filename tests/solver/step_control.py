"""Scenes whose cost tells whether the step control works, and their costs: fifteen, and those of the laws.

    PYTHONPATH=tests .venv/bin/python tests/solver/step_control.py

measures them anew on the built FMU and writes step_control*.csv.

To be done when a method has been changed deliberately: the accuracy tests say whether its results are
right, these numbers only that it still takes the work it took. A spoilt step control often costs work and
no accuracy.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from data.laws import LawScene, law_scenes
from data.sweep import SWEEP

from frictionlab.fmu import FrictionFmu, Value
from frictionlab.project import ROOT

TABLE = Path(__file__).with_suffix(".csv")
TABLE_OF_LAWS = Path(__file__).with_name("step_control_of_laws.csv")
PERIOD = 1.0 / 20e3
SLIDER: Mapping[str, Value] = {"V": 0.005, "vibration.V_1": 1.44}
NORMAL: Mapping[str, Value] = {"vibration.a_d": 1.1e-6, "vibration.phase_d": 0.7}
BELLS: Mapping[str, Value] = {
    **SLIDER,
    **NORMAL,
    "friction.model": "LuGre",
    "friction.staticRatio": 1.3,
    "friction.V_S": 0.0144,
}


@dataclass(frozen=True)
class Scene:
    start: Mapping[str, Value]
    h: float  # s
    steps: int = 1
    rates: Mapping[str, float] = field(default_factory=dict)  # of the inputs, per second


SCENES = {
    "stiff": Scene({**SLIDER, **NORMAL}, PERIOD),
    "soft": Scene({**SLIDER, **NORMAL, "contact.stiffnessScale": 1e-8}, 1.3 * PERIOD, 10),
    "settled, small steps": Scene(
        {"V": 0.5, "vibration.V_1": 0.3, **NORMAL, "contact.stiffnessScale": 1e-4}, PERIOD / 50, 200
    ),
    "a dip with V > V_1": Scene(
        {"V": 1.4401, "vibration.V_1": 1.44, "contact.stiffnessScale": 1e-2}, 1.3 * PERIOD, 10
    ),
    "a grazing reversal": Scene(
        {"V": 1.4399999, "vibration.V_1": 1.44, "contact.stiffnessScale": 1e-2}, 1.3 * PERIOD, 10
    ),
    "a_d near d": Scene({**SLIDER, "vibration.a_d": 13.9e-6, "contact.stiffnessScale": 1e-6}, PERIOD),
    "a_d two thirds of d": Scene({**SLIDER, "vibration.a_d": 10e-6, "contact.stiffnessScale": 1e-3}, PERIOD),
    "a_d nine tenths of d": Scene(
        {**SLIDER, "vibration.a_d": 12.5e-6, "contact.stiffnessScale": 1e-3}, PERIOD
    ),
    "tolerance 1e-12": Scene({**SLIDER, **NORMAL, "solver.tolerance": 1e-12}, PERIOD),
    "tolerance 1e-3": Scene({**SLIDER, **NORMAL, "solver.tolerance": 1e-3}, 7.7 * PERIOD),
    "inputs that move": Scene(
        {**SLIDER, **NORMAL, "contact.stiffnessScale": 1e-5}, 5.5 * PERIOD, 3, {"V": -40.0, "d": 2e-3}
    ),
    "the limit and the surfaces follow a load": Scene(
        {
            **SLIDER,
            **NORMAL,
            "friction.model": "LuGre",
            "friction.staticRatio": 1.4,
            "friction.limit": "Load",
            "contact.input": "Load",
            "contact.stiffnessScale": 1e-4,
        },
        2.2 * PERIOD,
        2,
    ),
    "ElasticPlastic, limit and stiffness move": Scene(
        {**SLIDER, **NORMAL, "friction.model": "ElasticPlastic", "friction.limit": "Load"}, 1.3 * PERIOD, 10
    ),
    "bells of the Stribeck curve, soft": Scene({**BELLS, "contact.stiffnessScale": 1e-8}, 0.93 * PERIOD, 10),
    "bells of the Stribeck curve, in layers": Scene(
        {**BELLS, "contact.stiffnessScale": 1e-4}, 0.93 * PERIOD, 10
    ),
}


def evaluations(fmu: FrictionFmu, scene: Scene) -> float:
    """Of the equation, over all steps of the scene."""
    with fmu.session(scene.start) as session:
        for _ in range(scene.steps):
            if scene.rates:
                session.set_rates(**scene.rates)
            session.step(scene.h)
        return session.get("solver.evaluations")


def _at_a_tolerance(law: str, tolerance: float | None) -> Callable[[FrictionFmu], list[list[float]]]:
    return lambda fmu: [_of_law_scene(fmu, scene, tolerance) for scene in law_scenes(law)]


# What is measured of each scene of tests/data, at its own tolerance if none is named.
FAMILIES: Mapping[str, Callable[[FrictionFmu], list[list[float]]]] = {
    "Dahl": _at_a_tolerance("Dahl", None),
    "Dahl at 1e-2": _at_a_tolerance("Dahl", 1e-2),
    "LuGre": _at_a_tolerance("LuGre", None),
    "LuGre at 1e-2": _at_a_tolerance("LuGre", 1e-2),
    "ElasticPlastic": _at_a_tolerance("ElasticPlastic", None),
    "Coulomb": _at_a_tolerance("Coulomb", None),
    "Settled": _at_a_tolerance("Settled", None),
    "cvode": lambda fmu: _with_cvode(fmu),
}


def _of_law_scene(fmu: FrictionFmu, scene: LawScene, tolerance: float | None) -> list[float]:
    """Of the start, and of each step."""
    start = scene.start_values | {"solver.tolerance": tolerance or scene.tolerance}
    with fmu.session(start, start=scene.steps[0].scene.start) as session:
        counts = [session.get("solver.evaluations")]
        for step in scene.steps:
            step.take(session)
            counts.append(session.get("solver.evaluations"))
    return [counts[0], *(after - before for before, after in pairwise(counts))]


def _with_cvode(fmu: FrictionFmu) -> list[list[float]]:
    """Of a step at 1e-5, where it is a short one."""
    counts = []
    for row in SWEEP:
        if row.h * row.scene.f < 3.0:
            start = row.start_values | {"solver.method": "cvode", "solver.tolerance": 1e-5}
            with fmu.session(start, start=row.scene.start) as session:
                if row.rates:
                    session.set_rates(**row.rates)
                session.step(row.h)
                counts.append([session.get("solver.evaluations")])
    return counts


def committed() -> dict[str, float]:
    with TABLE.open(newline="") as rows:
        return {row["scene"]: float(row["evaluations"]) for row in csv.DictReader(rows)}


def committed_of_laws() -> dict[str, list[list[float]]]:
    counts: dict[str, list[list[float]]] = {}
    with TABLE_OF_LAWS.open(newline="") as rows:
        for row in csv.DictReader(rows):
            counts.setdefault(row["family"], []).append(
                [float(count) for count in row["evaluations"].split()]
            )
    return counts


def write_table(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def main() -> None:
    with FrictionFmu(ROOT / "build" / "FrictionContact.fmu") as fmu:
        own = [(name, f"{evaluations(fmu, scene):g}") for name, scene in SCENES.items()]
        of_laws = [
            (family, number, " ".join(f"{count:g}" for count in counts))
            for family, measure in FAMILIES.items()
            for number, counts in enumerate(measure(fmu))
        ]
    write_table(TABLE, ("scene", "evaluations"), own)
    write_table(TABLE_OF_LAWS, ("family", "scene", "evaluations"), of_laws)


if __name__ == "__main__":
    main()
