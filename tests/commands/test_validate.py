"""docs/validation.md says what the laws give for the measurements, and scripts/validate prints it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from frictionlab.fmu import FrictionFmu
from frictionlab.project import ROOT
from frictionlab.validate import command, longitudinal, loop, measurements, normal

PAGE = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")


def row(cells: list[str]) -> str:
    return " | ".join(cells)


def test_the_dry_rows(fmu_path: Path) -> None:
    data = measurements.sliding("dry")
    for law in longitudinal.LAWS:
        fit = longitudinal.fit(fmu_path, data, law)
        cells = [f"{force:.4f}" for force in fit.model]
        cells += [f"{longitudinal.rms(model, data.vibrated):.3f}" for model in (fit.model, fit.predicted)]
        assert row(cells) in PAGE, law
        if law == "Dahl":
            # All that it can give lies from (2/pi) F_C asin zeta to F_C zeta / mean |zeta + cos|.
            zeta = data.V / data.V_1
            stiff = 2 / np.pi * data.without * np.arcsin(zeta)
            turn = np.arccos(-zeta)
            soft = data.without * zeta * np.pi / (2 * (zeta * turn + np.sin(turn)) - zeta * np.pi)
            assert fit.least == pytest.approx(stiff, rel=1e-3)
            assert fit.most == pytest.approx(soft, rel=1e-3)
            assert np.all(data.vibrated > 3.7 * fit.most)
    assert f"{1e-6 * fit.stiffness:.2f} N/µm" in PAGE
    assert f"within a factor of {fit.factor:.2f}" in PAGE
    assert f"{longitudinal.static_friction(data, fit.stiffness):.2f} N either" in PAGE
    ratio = longitudinal.constant_ratio(data)
    assert row([f"{force:.4f}" for force in ratio.model]) in PAGE
    assert f"misses by {longitudinal.rms(ratio.model, data.vibrated):.3f} N" in PAGE


def test_the_oiled_rows_follow_no_law(fmu_path: Path) -> None:
    data = measurements.sliding("oil")
    fit = longitudinal.fit(fmu_path, data, "ElasticPlastic")
    ratio = longitudinal.constant_ratio(data)
    assert longitudinal.rms(fit.model, data.vibrated) > longitudinal.rms(ratio.model, data.vibrated)
    assert f"ElasticPlastic is {longitudinal.rms(fit.model, data.vibrated):.3f} N" in PAGE
    assert f"({longitudinal.rms(ratio.model, data.vibrated):.3f} N)" in PAGE
    assert f"by a factor of {fit.factor:.2f}" in PAGE


def test_normal_vibration(fmu_path: Path) -> None:
    data = measurements.normal_vibration()
    held = normal.reduction(fmu_path, "Dahl", data.f, data.V, 2.0, np.array([1e-6]), "Constant")
    assert held == pytest.approx(np.zeros(2), abs=1e-6)
    for law in normal.LAWS:
        fits = [normal.fit(fmu_path, data, law, float(swing)) for swing in normal.SWINGS]
        cells = ["none reaches 62 %" if f.predicted is None else f"{100 * f.predicted:.1f} %" for f in fits]
        assert row(cells) in PAGE, law


@pytest.mark.slow
def test_the_loop(fmu: FrictionFmu) -> None:
    data = measurements.loop()
    for law in ("Dahl", "ElasticPlastic"):
        fit = loop.fit(fmu, data, law)
        cells = [f"{1e-3 * fit.stiffness:.2f}", f"{fit.F_C:.3f}"]
        cells += [f"{100 * fit.rms_fitted:.1f} %", f"{100 * fit.rms_predicted:.1f} %", f"{fit.work:.3f}"]
        assert row(cells) in PAGE, law


def test_the_command_prints_its_tables_and_draws(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command.main(["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path / "out")])
    text = capsys.readouterr().out
    assert "Longitudinal vibration, dry" in text
    assert "Normal vibration" in text
    assert sorted(path.suffix for path in (tmp_path / "out").iterdir()) == [".png", ".png", ".svg", ".svg"]


def test_an_output_that_can_not_be_written_is_one_line(fmu_path: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(SystemExit, match=r"error: .*file"):
        command.main(["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path / "file" / "out")])
