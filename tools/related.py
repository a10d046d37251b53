"""Writes the results that the FMU carries: data/related/EXPERIMENT.csv, from the independent reference.

    python -m tools.related

The folder is extra/org.fmi-standard.fmi-ls-ref/ of the FMU, by the layered standard FMI-LS-REF 1.0.0-beta.1.
The reference solves Eq. 1-4, 12-14, 20-22 and 24 by itself, in extended precision: no number is the FMU's.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from frictioncontact.command import write_csv
from tools.presets import RELATED as FOLDER
from tools.presets import presets
from tools.reference import changed, follow, rest, scene_of, settled_deflection

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
    found = [dict(each.attrib) for each in etree.parse(FOLDER / "validation.exp").getroot()]
    return [
        Experiment(x["name"], values.get(x["name"], {}), float(x["stopTime"]), float(x["stepSize"]))
        for x in found
    ]


def rows(experiment: Experiment) -> Iterator[dict[str, float]]:
    """A row for each communication point, in the order and units of COLUMNS."""
    scene = changed(scene_of(experiment.values), h=experiment.step)
    steps = follow([scene] * round(experiment.stop / experiment.step))
    settled = experiment.values.get("initialState") == "Settled"
    F_t = mean = steps[0].F_t_start
    work, delta = 0.0, settled_deflection(scene) if settled else scene.delta_0
    for k, found in enumerate([None, *steps]):
        if found:
            F_t, mean, work, delta = found.F_t, found.F_t_mean, work + found.W_f, found.delta
        t = experiment.step * k
        d = scene.d + scene.a_d * math.cos(2.0 * math.pi * math.fmod(scene.f * t, 1.0) + scene.phase_d)
        _, sigma = rest(changed(scene, d=d, a_d=0.0))
        A_r = math.sqrt(sigma * d**3 / (scene.stiffnessScale * scene.E))  # Eq. 3
        values = (t, F_t, mean, work, sigma, A_r, delta)
        yield dict(zip(COLUMNS, values, strict=True))


if __name__ == "__main__":
    for experiment in experiments():
        write_csv(list(rows(experiment)), experiment.result)
        print(experiment.result.name)
