"""Every line of docs/measured-parameters.md, set in the FMU, gives the measured friction."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import frictioncontact as fc
from frictioncontact.batch import simulate_many
from frictioncontact.fmu import FrictionFmu
from tools.project import ROOT
from tools.validate import measurements, record

PAGE = (ROOT / "docs" / "measured-parameters.md").read_text(encoding="utf-8")
LINES = re.findall(r"^    ((?:[\w.]+ [-\d.e]+ ?)+)$", re.sub(r"\\\n +", "", PAGE), re.MULTILINE)


def start_values(line: str) -> dict[str, float | int]:
    """As fmpy reads them: integers are numbers of items."""
    words = line.split()
    return {
        name: int(text) if text.isdigit() else float(text)
        for name, text in zip(words[::2], words[1::2], strict=True)
    }


def lines_with(**values: float) -> list[dict[str, float | int]]:
    found = [
        line
        for line in map(start_values, LINES)
        if all(line.get(name.replace("__", ".")) == value for name, value in values.items())
    ]
    assert found
    return found


def test_the_package_has_the_contacts_of_the_page(fmu: FrictionFmu) -> None:
    """Value for value; and what the page says of the first holds for the output that it names."""
    starts = [
        {name: float(fmu.known.numbers(name, value, name)) for name, value in contact.start.items()}
        for contact in fc.contacts.values()
    ]
    assert len(starts) == len(LINES)
    for line, start in zip(map(start_values, LINES), starts, strict=True):
        assert line.items() <= start.items()
    for contact in fc.contacts.values():
        for name, (low, high) in contact.intervals.items():
            assert low < contact.start[name] < high
    assert fc.friction_law(fc.contacts["steel-dry"].start)(0.5e-3) == pytest.approx(0.283, abs=5e-4)


def test_steel_under_vibration(fmu_path: Path) -> None:
    """The five rows of the source; what the page says of them is the source's, and the FMU's."""
    data = measurements.sliding("dry")
    (line,) = lines_with(vibration__f=26e3)
    assert line["vibration.V_1"] == pytest.approx(data.V_1, rel=1e-6)
    assert line["F_C"] == data.without[data.V == line["V"]]
    found = simulate_many(line | {"V": data.V, "F_C": data.without}, fmu=fmu_path)["F_t_mean"]
    assert np.abs(found - data.vibrated).max() < 0.06  # N
    assert np.sqrt(np.mean((found - data.vibrated) ** 2)) == pytest.approx(0.049, abs=5e-4)
    rows = np.array(
        re.findall(r"^\| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", PAGE, re.MULTILINE), float
    )
    np.testing.assert_allclose(
        rows[:, :3], np.transpose([1e3 * data.V, data.without, data.vibrated]), rtol=1e-12
    )
    np.testing.assert_allclose(rows[:, 3], found, rtol=0, atol=5e-4)


@pytest.mark.parametrize(
    ("law", "misfit", "work"), [(3, 0.061, 1.027), (1, 0.105, 0.969)], ids=["ElasticPlastic", "Dahl"]
)
def test_cycles_at_5_N(fmu: FrictionFmu, law: int, misfit: float, work: float) -> None:
    """The 47 cycles that the lines were not fitted to, from the measured friction on."""
    whole = measurements.record()
    cycles = record.predicted_cycles(whole)
    (line,) = lines_with(friction__model=law, load=5)
    limit = line["friction.mu"] * line["load"]
    start = np.clip(cycles.friction[0], -limit, limit) / line["contact.sigma"]
    found = record.along_path(fmu, cycles, line | {"delta_0": float(start)})
    error = measurements.rms(found - cycles.friction) / record.sliding_friction(whole)
    assert error == pytest.approx(misfit, abs=6e-4)  # as the page rounds it
    ratio = record.work(found, cycles) / record.work(cycles.friction, cycles)
    assert ratio == pytest.approx(work, abs=2e-3)
    assert f"{100 * misfit:g} %" in PAGE
