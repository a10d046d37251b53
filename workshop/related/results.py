"""Writes the results that the FMU carries: data/related/EXPERIMENT.csv, from the independent reference.

    python -m workshop.related.results

Takes a minute. The reference solves Eq. 1-4, 12-14, 20-22 and 24 by itself, in extended precision: no number
is the FMU's.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from frictioncontact.command import write_csv
from workshop.presets import presets
from workshop.project import ROOT
from workshop.reference import solution as reference
from workshop.reference.arithmetic import MP, MULTIPRECISION, multiprecision
from workshop.reference.contact import area
from workshop.reference.scene import Drive
from workshop.reference.start_values import scene_of

FOLDER = ROOT / "data" / "related"
COLUMNS = ("time", "F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")


@dataclass(frozen=True)
class Experiment:
    """One run from t = 0; times in s."""

    name: str
    values: dict[str, float | str]  # start values that differ from those of the model description
    stop: float
    step: float

    @property
    def result(self) -> Path:
        return FOLDER / f"{self.name}.csv"


def experiments() -> list[Experiment]:
    """Those of validation.exp."""
    values = {preset.id: preset.values for preset in presets()}
    return [
        Experiment(
            each.get("name"),
            values.get(each.get("name"), {}),
            float(each.get("stopTime")),
            float(each.get("stepSize")),
        )
        for each in etree.parse(FOLDER / "validation.exp").getroot()
    ]


def rows(experiment: Experiment) -> Iterator[dict[str, float]]:
    """A row for each communication point, in the order and units of COLUMNS."""
    scene = scene_of(experiment.values)
    count = round(experiment.stop / experiment.step)
    settled = experiment.values.get("initialState") == "Settled"
    delta, work = multiprecision(reference.periodic_deflection(scene) if settled else 0), MP.mpf(0)
    for k in range(count + 1):
        t = experiment.step * k
        mean = reference.force(scene, 0, delta)
        if k:
            before = experiment.step * (k - 1)
            delta, impulse, step_work = map(multiprecision, reference.solve(scene, before, t, delta))
            mean, work = impulse / (MP.mpf(t) - MP.mpf(before)), work + step_work
        drive = Drive(scene, t, MULTIPRECISION)
        force = reference.force(scene, t, delta)
        A_r = area(scene.contact, drive.d(MP.mpf(0)), drive.E(MP.mpf(0)))
        values = (t, force, mean, work, reference.sigma(scene, t), A_r, delta)
        yield dict(zip(COLUMNS, map(float, values), strict=True))


if __name__ == "__main__":
    for experiment in experiments():
        write_csv(list(rows(experiment)), experiment.result)
        print(experiment.result.name)
