"""docs/validation.md says what the laws give for the measurements, and scripts/validate prints it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from frictioncontact.command import main
from frictioncontact.fmu import FrictionFmu
from workshop.project import ROOT
from workshop.validate import command, elements, longitudinal, measurements, normal, record

PAGE = " ".join((ROOT / "docs" / "validation.md").read_text(encoding="utf-8").split())


def row(cells: list[str]) -> str:
    return " | ".join(cells)


def percent(part: float) -> str:
    return f"{100 * part:.1f} %"


def test_the_dry_rows(fmu_path: Path) -> None:
    data = measurements.sliding("dry")
    for law in longitudinal.LAWS:
        fit = longitudinal.fit(fmu_path, data, law)
        cells = [f"{force:.4f}" for force in fit.model]
        cells += [f"{measurements.rms(model - data.vibrated):.3f}" for model in (fit.model, fit.predicted)]
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
    assert f"ElasticPlastic, {1e-6 * fit.stiffness:.3f} N/µm" in PAGE
    assert f"within a factor of {fit.factor:.2f}" in PAGE
    assert f"{data.static_without - fit.stiffness * data.amplitude:.2f} N for" in PAGE
    assert f"deflection F_C/k = {1e6 * float(data.without[0]) / fit.stiffness:.2f} µm" in PAGE
    misfit = measurements.rms(fit.model - data.vibrated)
    assert f"{100 * misfit / data.vibrated.mean():.0f} % of the mean vibrated friction" in PAGE
    assert f"{100 * misfit / data.without.mean():.0f} % of F_C" in PAGE
    missed = measurements.rms(fit.predicted - data.vibrated)
    said = f"rms error of its predictions, {missed:.3f} N, is {100 * missed / data.vibrated.mean():.0f} %."
    assert said in PAGE
    assert f"F_C - k a = {data.without[0] - fit.stiffness * data.amplitude:.3f} N" in PAGE
    assert longitudinal.STRIBECK == 1e-4 and "V_S = 0.1 mm/s" in PAGE
    moved = 5e-9 * fit.stiffness  # N, by an error of 5 nm in the amplitude
    assert f"moves it by {moved:.3f} N, {100 * moved / misfit:.0f} % of the rms error" in PAGE
    for baseline in (each(data) for each in longitudinal.BASELINES):
        cells = [f"{force:.4f}" for force in baseline.model]
        cells += [
            f"{measurements.rms(model - data.vibrated):.3f}" for model in (baseline.model, baseline.predicted)
        ]
        assert row(cells) in PAGE, baseline.law
    plain = longitudinal.constant_force(data)
    parts = [100 * measurements.rms(each - data.vibrated) for each in (plain.model, plain.predicted)]
    assert "one constant force by {:.0f} and {:.0f} %".format(*parts / data.vibrated.mean()) in PAGE


def test_the_oiled_rows_follow_no_law(fmu_path: Path) -> None:
    data = measurements.sliding("oil")
    fit = longitudinal.fit(fmu_path, data, "ElasticPlastic")
    ratio = longitudinal.constant_ratio(data)
    assert measurements.rms(fit.model - data.vibrated) > measurements.rms(ratio.model - data.vibrated)
    assert f"ElasticPlastic is {measurements.rms(fit.model - data.vibrated):.3f} N" in PAGE
    assert f"({measurements.rms(ratio.model - data.vibrated):.3f} N)" in PAGE
    plain = longitudinal.constant_force(data)
    assert f"({measurements.rms(plain.model - data.vibrated):.3f} N)" in PAGE
    assert f"by a factor of {fit.factor:.2f}" in PAGE


def test_a_baseline_predicts_a_row_without_having_seen_it() -> None:
    data = measurements.sliding("dry")
    baseline = longitudinal.logarithm(data)
    others = np.arange(1, len(data.V))
    slope, offset = np.polyfit(np.log(data.V[others]), data.vibrated[others], 1)
    assert baseline.predicted[0] == pytest.approx(offset + slope * math.log(data.V[0]))


def test_under_normal_vibration_a_constant_limit_predicts_nothing(fmu_path: Path) -> None:
    data = measurements.normal_vibration()
    held = normal.reduction(fmu_path, "Dahl", data.f, data.V, 2.0, np.array([1e-6]), "Constant")
    assert held == pytest.approx(np.zeros(2), abs=1e-6)


@pytest.mark.parametrize("law", normal.LAWS)
def test_normal_vibration(fmu_path: Path, law: str) -> None:
    data = measurements.normal_vibration()
    fits = [normal.fit(fmu_path, data, law, float(swing)) for swing in normal.SWINGS]
    assert row(["-" if fit.predicted is None else percent(fit.predicted) for fit in fits]) in PAGE


def test_an_empirical_formula_stands_beside_the_normal_vibration() -> None:
    at_second, _ = normal.hyperbola(measurements.normal_vibration())
    assert f"gives {percent(at_second)} at 87 mm/s" in PAGE


def test_the_record_is_what_its_page_says() -> None:
    data = measurements.record()
    from_mean, from_last, work = record.scatter(data)
    assert f"{percent(from_mean)} from the mean cycle" in PAGE
    assert f"{percent(from_last)} from the one before" in PAGE
    assert f"The work scatters by {percent(work)}" in PAGE
    assert f"sliding friction, {record.sliding_friction(data):.2f} N" in PAGE
    assert abs(data.between(0.0, record.UNLOADED).friction.mean()) < 5e-4
    same, later = record.repeated(data), record.predicted_cycles(data)
    error = measurements.rms(same.friction - later.friction) / record.sliding_friction(data)
    ratio = record.work(same.friction, later) / record.work(later.friction, later)
    assert f"the mean of the two cycles | | | | {percent(error)} | {ratio:.3f} |" in PAGE
    assert f"within {1e6 * measurements.rms(same.position - later.position):.2f} µm (rms)" in PAGE
    path = np.ptp(data.between(*record.UNLOADING).position)
    assert f"moves by {1e6 * path:.1f} µm" in PAGE


@pytest.fixture(scope="module")
def fits(fmu: FrictionFmu) -> dict[str, record.RecordFit]:
    data = measurements.record()
    return {law: record.fit(fmu, data, law) for law in record.LAWS}


@pytest.mark.slow
def test_the_cycles_and_the_unloading(fits: dict[str, record.RecordFit]) -> None:
    data = measurements.record()
    for law in ("Dahl", "ElasticPlastic"):
        fit = fits[law]
        cells = [f"{1e-3 * fit.stiffness:.2f}", f"{fit.mu:.3f}"]
        cells += [percent(fit.rms_fitted), percent(fit.rms_predicted), f"{fit.work:.3f}"]
        assert row(cells) in PAGE, law
    assert f"Coulomb (rms {100 * fits['Coulomb'].rms_predicted:.0f} %)" in PAGE

    part = data.between(*record.UNLOADING)
    dahl, elastic_plastic = fits["Dahl"], fits["ElasticPlastic"]
    without = record.without_bound(data, dahl)
    for name, friction in (
        ("ElasticPlastic, limit μ F_n", elastic_plastic.unloading),
        ("Dahl, limit μ F_n in Eq. 2 alone", without),
        ("ElasticPlastic, constant limit", elastic_plastic.constant_limit),
        ("Dahl, constant limit", dahl.constant_limit),
    ):
        assert unloading_row(data, name, friction) in PAGE
    least, most = record.over_the_load(data, part.friction)
    assert f"stays between {least:.3f} and {most:.3f}" in PAGE

    assert without == pytest.approx(in_short_pieces(part, dahl, bounded=False), abs=2e-3)


@pytest.mark.slow
def test_a_bounded_bristle_unloads(fits: dict[str, record.RecordFit]) -> None:
    data, dahl = measurements.record(), fits["Dahl"]
    expected = in_short_pieces(data.between(*record.UNLOADING), dahl, bounded=True)
    assert dahl.unloading == pytest.approx(expected, abs=2e-3)
    assert unloading_row(data, "Dahl, limit μ F_n, bounded by it", dahl.unloading) in PAGE


def unloading_row(data: measurements.Record, name: str, friction: np.ndarray) -> str:
    ratios = [f"{ratio:.3f}" for ratio in record.over_the_load(data, friction)]
    return row([name, percent(record.misfit_of_unloading(data, friction)), *ratios])


def in_short_pieces(part: measurements.Record, fit: record.RecordFit, bounded: bool) -> np.ndarray:
    """Dahl's force at the samples [N], the limit held over a fiftieth of each interval.

    Its closed form over a path dx at a held limit L is F -> s L + (F - s L) exp(-k |dx| / L), s = sgn dx.
    """
    pieces = 50
    load = np.maximum(part.load, record.LEAST_LOAD)
    forces = [float(fit.unloading[0])]
    for dx, begin, end in zip(np.diff(part.position), load, load[1:], strict=False):
        F = forces[-1]
        for limit in fit.mu * (begin + (end - begin) * (np.arange(pieces) + 0.5) / pieces):
            final = math.copysign(limit, dx)
            F = final + (F - final) * math.exp(-fit.stiffness * abs(dx) / pieces / limit)
            F = min(max(F, -limit), limit) if bounded else F
        forces.append(F)
    return np.array(forces)


@pytest.mark.slow
def test_more_elements_hardly_help_and_a_tilt_does() -> None:
    for fit in elements.fits(measurements.record()):
        assert row([percent(fit.rms_fitted), percent(fit.rms_predicted)]) in PAGE, fit.name
    assert f"{fit.tilt:.3f} N/N" in PAGE


def test_elements_in_parallel_share_one_element_s_force() -> None:
    part = record.fitted_cycles(measurements.record())
    one = elements.forces(part, (np.array([4e4]), np.array([0.47]), 0.0))
    halves = elements.forces(part, (np.array([2e4, 2e4]), np.array([0.235, 0.235]), 0.0))
    assert halves == pytest.approx(one)
    assert np.max(np.abs(one) / part.load) == pytest.approx(0.47)


def test_the_command_prints_its_tables_and_draws(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(command, ["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path / "out")])
    text = capsys.readouterr().out
    assert "Longitudinal vibration, dry" in text
    assert "Normal vibration" in text
    assert sorted(path.suffix for path in (tmp_path / "out").iterdir()) == [".png", ".png"]
