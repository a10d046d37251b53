"""scripts/identify: it recovers what made the data, says what they can't tell, refuses what is no data."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats
from scipy.optimize import least_squares

import frictioncontact as fc
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification import command as identify
from frictioncontact.identification.api import fitted
from frictioncontact.identification.data import Measurements, read
from frictioncontact.identification.experiment import Record, Rows, parameter
from frictioncontact.identification.fit import search
from frictioncontact.identification.judge import CHANCE, misfits, suspicion
from frictioncontact.parameters import STIFFNESS_PRINTED
from tools.project import ROOT
from tools.validate import longitudinal
from tools.validate.measurements import sliding

GUIDE = " ".join((ROOT / "docs" / "measured-parameters.md").read_text(encoding="utf-8").split())
DRY = ROOT / "data" / "dry.csv"
ELASTIC = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}


def test_exact_data_give_the_truth_from_no_start_value(fmu_path: Path) -> None:
    truth = {"contact.stiffnessScale": 2e-6, "vibration.phase_d": 2.2, "F_C": 160.0}
    grid = np.array([(V, a, d) for V in (0.2, 0.6) for a in (0.5, 1.0, 1.5) for d in (0.0, 1e-6)]).T
    rows = dict(zip(("V", "vibration.V_1", "vibration.a_d"), grid, strict=True))
    means = fc.simulate_many({**rows, **truth, "solver.tolerance": 1e-9}, ["F_t_settled"], fmu=fmu_path)
    found = fc.identify({**rows, "F_t_mean": means["F_t_settled"]}, truth.keys(), fmu=fmu_path)
    for name, right in truth.items():
        low, high = found.intervals[name]
        assert found.values[name] == pytest.approx(right, rel=1e-5)
        assert right * 0.999 < low < right < high < right * 1.001
    assert "can't tell" not in str(found)


def test_profile_is_the_hull_of_the_region_on_a_grid(fmu: FrictionFmu) -> None:
    """Every value with which some other makes the misfit small enough, without any search."""
    rows = read(identify.EXAMPLE, fmu, {})
    named = [parameter(fmu, name, None, None, {}) for name in ("contact.stiffnessScale", "vibration.phase_d")]
    experiment = Rows(fmu, rows, named)
    result = fitted(experiment)
    assert any("an identification, not a validation" in text for text in result.warnings)
    assert any("another solution" in text for text in result.warnings)
    edge = result.squares * (1.0 + stats.t.ppf(0.975, 1) ** 2)  # with one degree of freedom
    scale, phase = np.linspace(math.log(1e-8), math.log(1e-5), 150), np.radians(np.arange(0.0, 360.0, 2.0))
    points = np.stack(np.meshgrid(scale, phase, indexing="ij"), axis=-1)
    forces = experiment.forces(points.reshape(-1, 2)).reshape(*points.shape[:2], 3)
    inside = np.sum((forces - rows.force) ** 2, axis=2) < edge
    scales, phases = scale[inside.any(axis=1)], phase[inside.any(axis=0)]
    assert result.profiles[0][0] == 0.0
    assert scales[0] == scale[0]
    assert math.log(result.profiles[0][1]) == pytest.approx(scales[-1], abs=1.5 * (scale[1] - scale[0]))
    assert result.profiles[1] == pytest.approx((phases[0], phases[-1]), abs=math.radians(3.0))
    most, (low, high) = 1e-6 * STIFFNESS_PRINTED * result.profiles[0][1], np.degrees(result.profiles[1])
    assert f"from above ({most:.0f} MN/m) and hardly bounds the phase ({low:.0f}° to {high:.0f}°)" in GUIDE


def test_what_the_data_can_not_tell_is_said(fmu_path: Path) -> None:
    """Coulomb's (2/pi) F_C asin(V / V_1) within 0.2 N; no vibration; two of which only the product counts."""

    def said(rows: dict[str, object], *names: str) -> str:
        return str(fc.identify(rows, names, fmu=fmu_path))

    scale = "contact.stiffnessScale"
    rows = {"V": [0.7, 0.8, 0.9, 0.5], "vibration.V_1": [1.0] * 4, "F_t_mean": [27.0, 32.6, 39.3, 18.2]}
    assert f"warning: the data can't tell {scale}: within 95 % it is at least" in said(rows, scale)
    text = said({"V": [0.5, 0.6, 0.7], "F_t_mean": [55.0, 55.2, 54.9]}, scale)
    (row,) = [line for line in text.splitlines() if "stiffnessScale │" in line]
    assert [cell.strip() for cell in row.split("│")][-3:-1] == ["not determined"] * 2
    rows = {"V": [0.2, 0.5, 0.8, 1.1], "vibration.V_1": [1.5] * 4, "F_t_mean": [11.0, 24.0, 33.0, 43.0]}
    text = said(rows, scale, "contact.eta")
    assert f"the data can't tell {scale}" in text and "the data can't tell contact.eta" in text


HEADER = "V [mm/s],vibration.V_1 [m/s],F_t_mean [N]\n"
GOOD = "20,0.5,31\n40,0.5,33\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (HEADER, "no rows of numbers"),
        (HEADER + GOOD + "50,0.5,-1e308\n", r"row 3 \(line 4\), column .*: -1e308 must be from -1e\+50 to"),
        ("V.uncertainty,V,F_t_mean\n1,1,1\n", "the uncertainty of V can't be weighed without"),
        ("time,F_t\n1,1\n", r"a series in time needs either 'position \[m\]' or 'V \[m/s\]'"),
        ("time,V,F_C,F_t\n1,1,1,1\n2,1,1,1\n3,1,1,1\n", "column F_C: a series takes inputs"),
        ("V,load,F_t_mean\n1,-5,4\n", r"row 1 \(line 2\), column 'load': -5 must be positive"),
        ("V,F_t_mean\n0.1,0\n0.2,0\n", "every measured force is 0 N"),
    ],
)
def test_bad_data_are_refused_by_row_and_column(
    fmu_path: Path, tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(UserError, match=message):
        fc.identify(path, "contact.sigma", start={"contact.model": "Constant"}, fmu=fmu_path)


def test_a_load_drives_limit_and_stiffness(fmu: FrictionFmu, tmp_path: Path) -> None:
    """Without vibration steady sliding is friction.mu times the load: a straight line through the rows."""
    path = tmp_path / "load.csv"
    path.write_text("V [m/s],load [kN],F_t_mean [N]\n0.1,0.1,20.5\n0.1,0.2,39\n0.1,0.3,61\n")
    found = fc.identify(path, "friction.mu", fmu=fmu.path)
    line = (100 * 20.5 + 200 * 39 + 300 * 61) / (100**2 + 200**2 + 300**2)
    assert found.values["friction.mu"] == pytest.approx(line, rel=1e-6)
    assert read(path, fmu, {"friction.limit": "Constant"}).conditions[0]["friction.limit"] == "Constant"


V = np.array([0.5, 1.0, 1.5, 2.0])  # m/s
LINE = {"V": V, "F_t_mean": [60.1, 64.8, 70.2, 74.9]}  # V, and F_C + sigma_2 V


@pytest.mark.parametrize("shared", [False, True])
def test_errors_of_inputs_widen_the_interval_by_their_share(fmu_path: Path, shared: bool) -> None:
    """An error of 0.03 m/s of V acts as one of 0.3 N; an error of sigma_2 is one in all rows."""
    name, error = ("friction.sigma_2", 0.1) if shared else ("V", 0.03)
    stated, start = {"F_t_mean": 0.2, name: error}, {"friction.sigma_2": 10.0}
    found = fc.identify(LINE, "F_C", start=start, uncertain=stated, fmu=fmu_path)
    of_rows = 0.01 * np.outer(V, V) if shared else 0.3**2 * np.eye(4)
    weights = np.linalg.inv(0.2**2 * np.eye(4) + of_rows)
    mean = np.sum(weights @ (np.array(LINE["F_t_mean"]) - 10.0 * V)) / np.sum(weights)
    deviation = 1.0 / math.sqrt(np.sum(weights))
    expected = [mean * math.exp(sign * 1.959964 * deviation / mean) for sign in (-1.0, 1.0)]
    assert found.fit.interval(0) == pytest.approx(expected, rel=1e-5)


def test_dry_rows_are_the_validation_s(fmu: FrictionFmu) -> None:
    """As scripts/validate finds otherwise; what the uncertainty decides is as page 2 of the tutorial says."""
    published = sliding("dry")
    rows = read(DRY, fmu, ELASTIC)
    assert rows.force == pytest.approx(list(published.vibrated))
    assert [row["F_C"] for row in rows.conditions] == pytest.approx(list(published.without))
    found = fc.identify(DRY, "contact.sigma", start=ELASTIC, fmu=fmu.path)
    sigma, (low, high) = found.values["contact.sigma"], found.intervals["contact.sigma"]
    expected = longitudinal.fit(fmu.path, published, "ElasticPlastic").stiffness
    assert sigma == pytest.approx(expected, rel=2e-3)
    assert f"{1e-6 * sigma:.2f} MN/m ({1e-6 * low:.2f} to {1e-6 * high:.2f})" in GUIDE
    page = " ".join((ROOT / "docs" / "tutorial" / "your-surface.md").read_text(encoding="utf-8").split())
    assert "we assume 0.05 N." in page and "is not rejected. At 0.025 N it would be." in page
    for uncertainty, faults in ((0.05, 0), (0.025, 1)):
        stated = {"F_t_mean": uncertainty}
        found = fc.identify(DRY, "contact.sigma", start=ELASTIC, uncertain=stated, fmu=fmu.path)
        assert len(found.misfits) == faults


def test_a_measured_loop(fmu: FrictionFmu) -> None:
    """Dahl's force after a path x at a held limit L: s L + (F - s L) exp(-sigma |x| / L), s its sign."""
    constants = {"contact.model": "Constant"}
    series = read(ROOT / "data" / "measurements" / "hysteresis.csv", fmu, constants)
    path, load = np.diff(series.position), series.inputs["load"]
    middle = 0.5 * (load[1:] + load[:-1])

    def errors(x: np.ndarray) -> np.ndarray:
        sigma, mu, force = math.exp(x[0]), x[1], x[2]
        forces = [force]
        for step, limit in zip(path, mu * middle, strict=True):
            end = math.copysign(limit, step)
            forces.append(end + (forces[-1] - end) * math.exp(-sigma * abs(step) / limit))
        return np.array(forces) - series.force

    expected = least_squares(errors, [math.log(3e4), 0.5, series.force[0]], x_scale=[1.0, 0.1, 1.0])
    named = [
        parameter(fmu, "contact.sigma", None, (1e3, 1e7), constants),
        parameter(fmu, "friction.mu", None, None, constants),
    ]
    experiment = Record(fmu, series, named)
    result = search(experiment, experiment.target)
    rms = math.sqrt(2.0 * expected.cost / len(series.force))
    assert result.values == pytest.approx([math.exp(expected.x[0]), expected.x[1]], rel=1e-3)
    assert np.sqrt(np.mean(result.residuals**2)) == pytest.approx(rms, rel=1e-4)
    times = rms / (np.std(np.diff(series.force, 2)) / math.sqrt(6.0))
    assert f"{times:.3g} times the scatter" in misfits(experiment, result)[0]
    assert f"{1e-6 * result.values[0]:.4f} MN/m and {result.values[1]:.3f}" in GUIDE
    assert f"a misfit of {rms:.2f} N, {times:.0f} times the scatter" in GUIDE


STUCK = {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.5, "friction.V_S": 0.01}
DAMPED = {"friction.model": "ElasticPlastic", "friction.sigma_1": 500.0, "friction.sigma_2": 300.0}


@pytest.mark.parametrize(
    ("scene", "V", "f", "first", "fitted"),
    [
        pytest.param(STUCK | {"delta_0": 65.0 / 4e6}, 0.02, 1e3, 0, (), id="stuck above F_C"),
        pytest.param({"vibration.V_1": 0.3, "vibration.f": 2e4}, 0.1, 1e3, 13, (), id="vibration"),
        pytest.param(DAMPED, 0.05, 100.0, 0, ("friction.sigma_1", "friction.sigma_2"), id="damping"),
    ],
)
def test_what_simulate_writes_gives_the_truth(
    fmu_path: Path, scene: dict, V: float, f: float, first: int, fitted: tuple[str, ...]
) -> None:
    """V sin(2 pi f t), 80 samples a period."""
    scene = {"contact.model": "Constant", "F_C": 50.0, "contact.sigma": 4e6} | scene
    time = np.arange(161) / (80.0 * f)
    drive = {"time": time, "V": V * np.sin(2.0 * np.pi * f * time)}
    data = fc.simulate(scene, stop=time[-1], step=time[1], inputs=drive, outputs=["V", "F_t"], fmu=fmu_path)
    fit = ("contact.sigma", *fitted)
    start = {name: value for name, value in scene.items() if name not in (*fit, "delta_0")}
    found = fc.identify(data[first:], fit, start=start, fmu=fmu_path)
    assert list(found.values.values()) == pytest.approx([scene[name] for name in fit], rel=0.002)


def test_a_record_without_scatter_is_judged(fmu_path: Path) -> None:
    """Steady sliding, F_t = F_C; a force that rises by 1/4 N from sample to sample is another law."""
    k, start = np.arange(41), {"contact.model": "Constant", "contact.sigma": 1e9}
    for rise, accuracy in ((0.0, 1e-6), (0.25, 0.01)):
        data = {"time": 1e-4 * k, "V": np.full(41, 0.1), "F_t": 40.0 + rise * k}
        found = fc.identify(data, "F_C", start=start, fmu=fmu_path)
        assert found.values["F_C"] == pytest.approx(np.mean(data["F_t"]), rel=accuracy)
        assert len(found.misfits) == (rise > 0.0)
    assert "is more than the scatter of neighbouring samples, 0 N" in found.misfits[0]


@pytest.mark.parametrize(
    ("V", "force", "order", "said"),
    [
        (range(1, 9), range(8), None, "rows of neighbouring V are alike"),
        ((3, 8, 1, 5, 7, 2, 6, 4), range(8), range(8), "have the shape of a drift of the force"),
        ((3, 8, 1, 5, 7, 2, 6, 4), range(8), None, ""),  # the order of rows alone says nothing
        ((3, 8, 1, 5, 7, 2, 6, 4), (2, 4, 0, 5, 1, 3, 7, 6), range(8), ""),
    ],
)
def test_differences_with_a_trend_are_a_misfit(
    fmu_path: Path, V: Sequence[int], force: Sequence[int], order: Sequence[int] | None, said: str
) -> None:
    """Of one force, F_C, at eight velocities: measured ones grow with V, from row to row, or with neither."""
    data = {"V [cm/s]": 10.0 * np.array(V), "F_t_mean": 50.0 + np.array(force)}
    data |= {} if order is None else {"order": order}
    found = fc.identify(data, "F_C", fmu=fmu_path)
    assert len(found.misfits) == bool(said)
    assert all(said in text for text in found.misfits)
    assert any("drift" in text for text in found.remedies) == ("drift" in said)


def test_scatter_is_seldom_suspicious() -> None:
    """Of 120 fits of a law that is right, at most so many as a chance of 1 % explains."""
    random = np.random.default_rng(1)
    V, V_1 = np.repeat(np.geomspace(0.01, 1.0, 6), 2), np.tile([0.0, 0.5], 6)
    conditions = [{"V": v, "vibration.V_1": a} for v, a in zip(V, V_1, strict=True)]
    rows = Measurements(("V", "vibration.V_1"), conditions, [0.0] * 12, None)
    slopes = np.stack([np.ones(12), V_1 * np.log(V)], axis=1)
    experiment = SimpleNamespace(rows=rows, word="row", weight=np.ones(12), force=np.full(12, 50.0))
    left = np.eye(12) - slopes @ np.linalg.pinv(slopes)
    told = 0
    for _ in range(120):
        result = SimpleNamespace(residuals=left @ random.standard_normal(12), slopes=slopes)
        told += suspicion(experiment, result, {"of a drift": np.arange(12.0)})[0] < CHANCE
    assert told <= stats.binom.ppf(0.99, 120, CHANCE)


def test_what_to_fit_is_said_as_on_the_command_line(fmu_path: Path) -> None:
    """Steady sliding, F_t_mean = F_C: of a range the bound that is nearest."""
    data = {"V": [0.1, 0.2, 0.3], "F_t_mean": [50.0, 51.0, 50.5]}
    for fit, value in (("F_C=40", 50.5), (["F_C=40..45"], 45.0), ({"F_C": (40.0, 45.0)}, 45.0)):
        assert fc.identify(data, fit, fmu=fmu_path).values["F_C"] == pytest.approx(value, rel=1e-4)
    for fit, message in ((["F_C=5..x"], "fit F_C=5..x: 'x' is not a number"), (["F_C", "F_C=3"], "twice")):
        with pytest.raises(UserError, match=message):
            fc.identify(data, fit, fmu=fmu_path)
