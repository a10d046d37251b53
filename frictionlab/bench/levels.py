"""Levels of the model: which friction law, contact and method a scene needs for an accuracy.

Every level is graded against the full one (Dahl bristle on the scene's own contact, solved by the reference).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from frictionlab.bench.cases import Case, expected, sampled, vibrating
from frictionlab.bench.coupling import Belt, monolithic
from frictionlab.bench.driver import Bench
from frictionlab.bench.grade import FIXED_STEP, Point, grade_point
from frictionlab.fmu import Value
from frictionlab.parameters import E_FULL, E_REDUCED, PERIOD, STIFFNESS_PRINTED, TABLE_2
from frictionlab.reference.solution import stiffness
from frictionlab.reference.start_values import scene_of

ACCURACIES = (1e-2, 1e-3, 1e-6)
SAME_COST = 1.1  # times that differ by less are the same
OUTPUTS = ("both", "F_t", "F_t_mean")


@dataclass(frozen=True)
class Level:
    friction: str
    contact: str
    method: str
    tolerance: float | None = None
    steps: int | None = None  # internal steps per communication step

    def settings(self, case: Case) -> dict[str, Value]:
        """The start values that make this level of the case's scene."""
        settings: dict[str, Value] = {"friction.model": self.friction, "contact.model": self.contact}
        scene = scene_of(case.start_values)
        if self.contact == "Constant" and scene.contact.model != "Constant":
            settings["contact.sigma"] = float(stiffness(scene.contact, scene.d, scene.E))
        settings["solver.method"] = self.method
        if self.tolerance is not None:
            settings["solver.tolerance"] = self.tolerance
        if self.steps is not None:
            settings["solver.stepSize"] = case.step / self.steps
        return settings

    def __str__(self) -> str:
        if self.friction == "Coulomb":
            return "Coulomb"
        detail = f"{self.tolerance:.0e}" if self.tolerance is not None else f"{self.steps} steps"
        return f"{self.friction}, {self.contact}, {self.method} {detail}"


@dataclass(frozen=True)
class Graded:
    level: Level
    point: Point

    def error(self, output: str = "both") -> float:
        return {
            "both": self.point.error,
            "F_t": self.point.error_F,
            "F_t_mean": self.point.error_mean,
        }[output]

    @property
    def kind(self) -> str:
        """The level without its setting."""
        level = self.level
        return "Coulomb" if level.friction == "Coulomb" else f"Dahl, {level.contact}, {level.method}"


def levels(case: Case, quick: bool) -> Iterator[Level]:
    own = scene_of(case.start_values).contact.model
    yield Level("Coulomb", own, "collocation")
    tolerances = (1e-2, 1e-4, 1e-8) if quick else (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10)
    steps = (1, 64, 1024) if quick else (1, 4, 16, 64, 256, 1024, 4096)
    for contact in dict.fromkeys(("Constant", own)):
        for tolerance in tolerances:
            yield Level("Dahl", contact, "collocation", tolerance)
            yield Level("Dahl", contact, "cvode", tolerance)
        for method in FIXED_STEP:
            for count in steps:
                yield Level("Dahl", contact, method, steps=count)


def grade(bench: Bench, case: Case, quick: bool) -> list[Graded]:
    """Cost and error of every level; cost in s per 50 us simulated."""
    references = {start: expected(case, start) for start in case.starts}
    graded = []
    for level in levels(case, quick):
        settings = {name.replace(".", "__"): value for name, value in level.settings(case).items()}
        budget = 0.003 if quick else 0.02
        measured = grade_point(
            case,
            references,
            level.method,
            level.tolerance or level.steps or 0.0,
            lambda start, settings=settings, budget=budget: bench.run(case.job(start, budget, **settings)),
        )
        graded.append(Graded(level, measured))
    return graded


def cheapest(graded: Sequence[Graded], accuracy: float, output: str = "both") -> Graded | None:
    """The simplest of the levels that cost least among those within the accuracy; None if there is none."""
    enough = [g for g in graded if not g.point.failure and g.error(output) <= accuracy]
    least = min((g.point.cpu for g in enough), default=0.0)
    return next((g for g in enough if g.point.cpu <= SAME_COST * least), None)


def best_of_each_kind(graded: Sequence[Graded], output: str = "both") -> dict[str, Graded]:
    """For each friction law, contact and method the setting with the smallest error."""
    best: dict[str, Graded] = {}
    for g in graded:
        if not g.point.failure and (g.kind not in best or g.error(output) < best[g.kind].error(output)):
            best[g.kind] = g
    return best


def _table_2() -> Iterator[Case]:
    for row in TABLE_2:
        values: Mapping[str, Value] = {
            "E": E_REDUCED if row.softened else E_FULL,
            "vibration.V_1": row.V_1,
            "vibration.a_d": row.a_d,
        }
        starts = (0.0, 0.23 * PERIOD) if row.V_1 else (0.0,)
        yield Case(f"table-2-row-{row.number}", f"Table 2, row {row.number}", values, starts=starts)


def _stick_slip() -> Case:
    """The velocity of the mass on a belt, as the monolithic reference has it."""
    belt, count = Belt(end=0.1), 100
    times = belt.end / count * np.arange(count + 1)
    velocity = np.array([belt.V(t) for t in times]) - monolithic(belt)(times)[1]
    scale = belt.sigma / STIFFNESS_PRINTED
    values: Mapping[str, Value] = {"F_C": belt.F_C, "contact.stiffnessScale": scale}
    return Case(
        "stick-slip",
        "stick-slip on a belt",
        values,
        belt.end / count,
        count,
        inputs={"V": velocity},
        linear=True,
    )


def scenes() -> list[Case]:
    """The scenes for which the table of levels is made."""
    presliding = sampled(40, 2.5e6, linear=True)
    return [
        Case("steady", "steady sliding, 0.1 ms steps", {}, step=1e-4, count=4),
        *_table_2(),
        replace(
            presliding,
            name="presliding",
            title="presliding hysteresis",
            inputs={"V": 0.3 * np.cos(2 * np.pi * np.arange(41) / 40)},
        ),
        _stick_slip(),
        replace(vibrating(2.5e6), name="soft", title="soft contact, V and d vibrate"),
        replace(vibrating(6e12), name="stiff", title="stiff contact, V and d vibrate"),
        replace(
            vibrating(2.5e6), name="many-periods", title="1 ms steps over 20 kHz", step=1e-3, starts=(0.0,)
        ),
    ]
