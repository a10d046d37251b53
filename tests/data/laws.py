"""The scenes of laws_<law>.csv, which make_laws.py makes."""

from __future__ import annotations

import csv
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path

from frictioncontact.fmu import Session
from workshop.reference.contact import Contact
from workshop.reference.scene import Scene
from workshop.reference.start_values import start_values_of

LAWS = ("Dahl", "LuGre", "ElasticPlastic", "Coulomb")


@dataclass(frozen=True)
class LawStep:
    scene: Scene  # with the inputs of this step; scene.start is its communication point
    h: float  # s
    F_t: float  # N     at the end of the step
    F_t_mean: float  # N
    W_f: float  # J     since the start of the scene
    Q_f: float  # J
    delta: float  # m
    scale: float  # N   what the tolerance is relative to
    energy: float  # J   the sum of scale times path since the start: the same of W_f and Q_f

    @property
    def rates(self) -> dict[str, float]:
        """Input derivatives that are not zero."""
        rates = {name: getattr(self.scene, f"{name}_rate") for name in ("V", "d", "E", "load")}
        return {name: rate for name, rate in rates.items() if rate != 0.0}

    def take(self, session: Session) -> None:
        """Sets the inputs of the step and takes it."""
        for name in ("V", "d", "E", "load"):
            session.set(name, getattr(self.scene, name))
        if self.rates:
            session.set_rates(**self.rates)
        session.step(self.h)


@dataclass(frozen=True)
class LawScene:
    number: int
    delta_0: float  # m
    settled: float | None  # m, the deflection to start from where initialState is Settled
    tolerance: float
    steps: list[LawStep]

    @property
    def start_values(self) -> dict[str, float | str]:
        values = start_values_of(self.steps[0].scene) | {"delta_0": self.delta_0}
        return values if self.settled is None else values | {"initialState": "Settled"}


_MOVING = ("start", *(f"{name}{end}" for name in ("V", "d", "E", "load") for end in ("", "_rate")))
_CONTACT = {field.name for field in fields(Contact)}
_TEXTS = {"friction", "limit", "input", "model"}


def _values(row: dict[str, str], names: set[str]) -> dict[str, float | str]:
    """What the row gives of the names; empty means the default."""
    return {name: row[name] if name in _TEXTS else float(row[name]) for name in names if row.get(name)}


@cache
def law_scenes(name: str) -> list[LawScene]:
    """A law's 200 scenes, or with the name Settled the 60 that start settled."""
    groups: dict[int, list[dict[str, str]]] = {}
    with Path(__file__).with_name(f"laws_{name.lower()}.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            groups.setdefault(int(row["scene"]), []).append(row)
    return [_scene(number, rows) for number, rows in groups.items()]


def _scene(number: int, rows: list[dict[str, str]]) -> LawScene:
    first = rows[0]
    lasting = {field.name for field in fields(Scene)} - {"contact", *_MOVING}
    whole = {**_values(first, lasting), "contact": Contact(**_values(first, _CONTACT))}
    steps, energy = [], 0.0
    for row in rows:
        scene = Scene(**whole, **_values(row, set(_MOVING)))
        energy += float(row["scale"]) * float(row["path"])
        results = (float(row[name]) for name in "h F_t F_t_mean W_f Q_f delta scale".split())
        steps.append(LawStep(scene, *results, energy))
    settled = float(first["settled"]) if first.get("settled") else None
    return LawScene(number, float(first["delta_0"]), settled, float(first["tolerance"]), steps)
