"""docs/validation.md says what the laws give for the measurements, and scripts/validate prints it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from figures import validate
from frictioncontact.command import main
from frictioncontact.fmu import FrictionFmu
from tools.project import ROOT
from tools.validate import longitudinal, measurements, normal, record

PAGE = " ".join((ROOT / "docs" / "validation.md").read_text(encoding="utf-8").split())


def row(cells: list[str]) -> str:
    return " | ".join(cells)


def percent(part: float) -> str:
    return f"{100 * part:.1f} %"


def test_the_dry_rows(fmu_path: Path) -> None:
    data = measurements.sliding("dry")
    fits = [longitudinal.fit(fmu_path, data, law) for law in longitudinal.LAWS]
    for fit in (*fits, *(baseline(data) for baseline in longitudinal.BASELINES)):
        cells = [f"{force:.4f}" for force in fit.model]
        cells += [f"{measurements.rms(model - data.vibrated):.3f}" for model in (fit.model, fit.predicted)]
        assert row(cells) in PAGE, fit.law
    # All that Dahl can give lies from (2/pi) F_C asin zeta to F_C zeta / mean |zeta + cos|.
    dahl = next(fit for fit in fits if fit.law == "Dahl")
    zeta = data.V / data.V_1
    turn = np.arccos(-zeta)
    soft = data.without * zeta * np.pi / (2 * (zeta * turn + np.sin(turn)) - zeta * np.pi)
    assert dahl.least == pytest.approx(2 / np.pi * data.without * np.arcsin(zeta), rel=1e-3)
    assert dahl.most == pytest.approx(soft, rel=1e-3)
    assert np.all(data.vibrated > 3.7 * dahl.most)
    plain = longitudinal.constant_force(data)
    parts = [100 * measurements.rms(each - data.vibrated) for each in (plain.model, plain.predicted)]
    assert "one constant force by {:.0f} and {:.0f} %".format(*parts / data.vibrated.mean()) in PAGE


@pytest.mark.parametrize("law", normal.LAWS)
def test_normal_vibration(fmu_path: Path, law: str) -> None:
    """A constant limit predicts no reduction."""
    data = measurements.normal_vibration()
    held = normal.reduction(fmu_path, law, data.f, data.V, 2.0, np.array([1e-6]), "Constant")
    assert law != "Dahl" or held == pytest.approx(np.zeros(2), abs=1e-6)
    fits = [normal.fit(fmu_path, data, law, float(swing)) for swing in normal.SWINGS]
    assert row(["-" if fit.predicted is None else percent(fit.predicted) for fit in fits]) in PAGE


@pytest.mark.slow
def test_the_cycles_and_the_unloading(fmu: FrictionFmu) -> None:
    data = measurements.record()
    fits = {law: record.fit(fmu, data, law) for law in ("Dahl", "ElasticPlastic")}
    for fit in fits.values():
        cells = [f"{1e-3 * fit.stiffness:.2f}", f"{fit.mu:.3f}"]
        assert row([*cells, percent(fit.rms_fitted), percent(fit.rms_predicted), f"{fit.work:.3f}"]) in PAGE
    part, dahl = data.between(*record.UNLOADING), fits["Dahl"]
    without = record.without_bound(data, dahl)
    for name, friction in (
        ("ElasticPlastic, limit μ F_n", fits["ElasticPlastic"].unloading),
        ("Dahl, limit μ F_n in Eq. 2 alone", without),
        ("Dahl, limit μ F_n, bounded by it", dahl.unloading),
        ("Dahl, constant limit", dahl.constant_limit),
    ):
        ratios = [f"{ratio:.3f}" for ratio in record.over_the_load(data, friction)]
        assert row([name, percent(record.misfit_of_unloading(data, friction)), *ratios]) in PAGE
    assert without == pytest.approx(in_short_pieces(part, dahl, bounded=False), abs=2e-3)
    assert dahl.unloading == pytest.approx(in_short_pieces(part, dahl, bounded=True), abs=2e-3)


def in_short_pieces(part: measurements.Record, fit: record.RecordFit, bounded: bool) -> np.ndarray:
    """Dahl's force at the samples [N], the limit held over a fiftieth of each interval.

    Its closed form over a path dx at a held limit L is F -> s L + (F - s L) exp(-k |dx| / L), s = sgn dx.
    """
    pieces = 50
    load = np.maximum(part.load, record.MIN_LOAD)
    forces = [float(fit.unloading[0])]
    for dx, begin, end in zip(np.diff(part.position), load, load[1:], strict=False):
        F = forces[-1]
        for limit in fit.mu * (begin + (end - begin) * (np.arange(pieces) + 0.5) / pieces):
            final = math.copysign(limit, dx)
            F = final + (F - final) * math.exp(-fit.stiffness * abs(dx) / pieces / limit)
            F = min(max(F, -limit), limit) if bounded else F
        forces.append(F)
    return np.array(forces)


def test_the_command_prints_its_tables_and_draws(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(validate, ["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path / "out")])
    text = capsys.readouterr().out
    assert "Longitudinal vibration, dry" in text and "Normal vibration" in text
    assert sorted(path.suffix for path in (tmp_path / "out").iterdir()) == [".png", ".png"]
