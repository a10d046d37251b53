"""The experiments whose results the FMU carries with it."""

from dataclasses import dataclass
from pathlib import Path

from workshop import description
from workshop.presets import presets
from workshop.project import ROOT

RESULTS = ROOT / "data" / "related"  # made by workshop.related.results


@dataclass(frozen=True)
class Experiment:
    """One run from t = 0; times in s."""

    name: str
    description: str
    values: dict[str, float | str]  # start values that differ from those of the model description
    stop: float
    step: float
    tolerance: float

    @property
    def result(self) -> Path:
        return RESULTS / f"{self.name}.csv"


def experiments() -> list[Experiment]:
    """The default experiment, and a row of Table 2 over four periods of its vibration."""
    default = description.read().defaultExperiment
    if default is None:
        raise ValueError(f"{description.XML}: DefaultExperiment is missing")
    stop, step, tolerance = (float(text) for text in (default.stopTime, default.stepSize, default.tolerance))
    row = next(preset for preset in presets() if preset.id == "table2-row2-identified")
    return [
        Experiment("default-experiment", "The default experiment", {}, stop, step, tolerance),
        Experiment(row.id, row.title, row.values, 2e-4, 1.25e-6, tolerance),
    ]
