"""The rows of sweep.csv, which make_sweep.py makes."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from workshop.reference.solution import Contact, Scene
from workshop.reference.start_values import start_values_of


@dataclass(frozen=True)
class SweepRow:
    number: int  # 0 is the first
    scene: Scene
    h: float  # s
    delta_0: float  # m
    tolerance: float
    F_t: float  # N     at the end of the step
    F_t_mean: float  # N
    work: float  # J

    @property
    def start_values(self) -> dict[str, float | str]:
        return start_values_of(self.scene) | {"delta_0": self.delta_0}

    @property
    def rates(self) -> dict[str, float]:
        """Input derivatives that are not zero."""
        rates = {"V": self.scene.V_rate, "d": self.scene.d_rate, "E": self.scene.E_rate}
        return {name: rate for name, rate in rates.items() if rate != 0.0}


_SCENE = "V d E V_rate d_rate E_rate start f V_1 a_d phase_d F_C".split()


def _read() -> list[SweepRow]:
    rows = []
    with Path(__file__).with_name("sweep.csv").open(newline="") as file:
        for number, row in enumerate(csv.DictReader(file)):
            contact = Contact(
                model=row["contact_model"],
                sigma=float(row["contact_sigma"]),
                stiffnessScale=float(row["stiffnessScale"]),
            )
            scene = Scene(**{name: float(row[name]) for name in _SCENE}, contact=contact)
            values = (float(row[name]) for name in "h delta_0 tolerance F_t F_t_mean work".split())
            rows.append(SweepRow(number, scene, *values))
    return rows


SWEEP = _read()
