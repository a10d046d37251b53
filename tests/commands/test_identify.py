"""scripts/identify: it recovers what made the data, says what they can't tell, refuses what is no data."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy import stats
from scipy.optimize import least_squares

import frictioncontact as fc
from frictioncontact.command import main
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification import command as identify
from frictioncontact.identification.bootstrap import bootstrap
from frictioncontact.identification.data import Measurements, Series, Uncertain, read
from frictioncontact.identification.experiment import Rows
from frictioncontact.identification.fit import Fit, fit
from frictioncontact.identification.parameter import parameter
from frictioncontact.identification.series import Record
from frictioncontact.identification.suspicion import CHANCE, suspicion
from frictioncontact.parameters import STIFFNESS_PRINTED
from workshop.project import ROOT
from workshop.report.recovery import (
    NOISE,
    TRUTH,
    Recovered,
    from_rows,
    measurements,
    recovered,
    true_forces,
)
from workshop.validate import longitudinal
from workshop.validate.measurements import sliding

GUIDE = (ROOT / "docs" / "measured-parameters.md").read_text(encoding="utf-8")

SEEDS = 20
ROWS = {  # uncertainty that is stated, relative error of V_1
    "scatter estimated": (None, 0.0),
    "V_1 uncertain": ([NOISE] * 12, 0.1),
}


LOOP_TRUTH = {"contact.sigma": 2.5e6, "F_C": 48.0}
LOOP_START = 5.0  # N, the force that a loop begins with
LOOP_NOISE = 0.3  # N, standard deviation of one sample
LOOPS = {"Dahl": True, "ElasticPlastic": False}  # law, whether the uncertainty is stated


def from_loops(fmu: FrictionFmu, seeds: int, law: str, stated: bool = True) -> Recovered:
    """From one noisy loop per seed: presliding at first, sliding at its ends later."""
    time = np.linspace(0.0, 2.0, 160)
    position = 60e-6 * np.sin(2.0 * np.pi * time) * (0.3 + 0.5 * time)
    constants = {"contact.model": "Constant", "friction.model": law}
    series = Series(
        time, np.gradient(position, time), {}, np.zeros(len(time)), constants,
        np.full(len(time), LOOP_NOISE) if stated else None, position,
    )  # fmt: skip
    named = [
        parameter(fmu, "contact.sigma", None, (1e3, 1e9), constants),
        parameter(fmu, "F_C", None, None, constants),
    ]
    first = Record(fmu, series, named)
    truth = [p.to_coordinate(LOOP_TRUTH[p.name]) for p in named]
    forces = first.forces(np.array([[*truth, LOOP_START]]))[0]
    return recovered(Record(fmu, replace(series, force=forces), named), LOOP_TRUTH, forces, LOOP_NOISE, seeds)


@pytest.fixture(scope="module")
def from_kind(fmu: FrictionFmu) -> Callable[[str], Recovered]:
    """What rows of a kind of ROWS give."""
    return cache(lambda kind: from_rows(fmu, SEEDS, *ROWS[kind]))


@pytest.fixture(scope="module")
def from_law(fmu: FrictionFmu) -> Callable[[str], Recovered]:
    """What loops of a law of LOOPS give."""
    return cache(lambda law: from_loops(fmu, SEEDS, law, LOOPS[law]))


def least(fits: list[Fit]) -> float:
    """So many 95 % intervals hold the truth with a probability of 99 %; 70 % intervals of 20 with 24 %."""
    return stats.binom.ppf(0.01, len(fits), 0.95)


@pytest.mark.parametrize("kind", ["scatter estimated", pytest.param("V_1 uncertain", marks=pytest.mark.slow)])
def test_intervals_hold_the_truth_in_about_95_percent_of_seeds(
    from_kind: Callable[[str], Recovered], kind: str
) -> None:
    found = from_kind(kind)
    for name in TRUTH:
        assert sum(found.holds(name)) >= least(found.fits), name
    if kind == "scatter estimated":
        assert sum(_inside_joint_region(one) for one in found.fits) >= least(found.fits)


@pytest.mark.parametrize("law", LOOPS)
def test_loops_are_recovered_too(from_law: Callable[[str], Recovered], law: str) -> None:
    for name in LOOP_TRUTH:
        assert sum(from_law(law).holds(name)) >= least(from_law(law).fits), name


def _inside_joint_region(one: Fit) -> bool:
    n = len(one.parameters)
    away = one.coordinates - np.array([p.to_coordinate(TRUTH[p.name]) for p in one.parameters])
    distance = float(away @ np.linalg.solve(one.covariance, away))
    return distance <= n * stats.f.ppf(0.95, n, one.degrees)


def test_exact_data_give_the_truth_from_no_start_value(fmu: FrictionFmu) -> None:
    named = [parameter(fmu, name, None, None, {}) for name in TRUTH]
    result = fit(Rows(fmu, measurements(true_forces(fmu)), named))
    assert result.values == pytest.approx(list(TRUTH.values()), rel=1e-5)
    for (low, high), truth in zip(result.profiles, TRUTH.values(), strict=True):
        assert truth * 0.999 < low < truth < high < truth * 1.001
    assert result.warnings == []


@pytest.mark.parametrize(("F_C", "sigma"), [(8.0, 1e6), (200.0, 1e7)])
def test_a_limit_far_from_the_start_value_is_found(fmu_path: Path, F_C: float, sigma: float) -> None:
    """ElasticPlastic from rest at a constant V: F_t = min(sigma V t, F_C)."""
    time = np.linspace(0.0, 5.0 * F_C / (sigma * 0.02), 15)
    data = pd.DataFrame({"time": time, "V": 0.02, "F_t": np.minimum(sigma * 0.02 * time, F_C)})
    law = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
    found = fc.identify(data, ["contact.sigma", "F_C"], start=law, fmu=fmu_path).values
    assert found["contact.sigma"] == pytest.approx(sigma, rel=1e-3)
    assert found["F_C"] == pytest.approx(F_C, rel=1e-3)


def test_fixed_parameter_is_fitted_too(fmu: FrictionFmu) -> None:
    rows = Measurements(
        ("V",), [{"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 5e-7}], [20.0], [0.1]
    )
    result = fit(Rows(fmu, rows, [parameter(fmu, "contact.R_q", 6e-6, None, {})]))
    assert result.model == pytest.approx([20.0], abs=1e-4)


def test_profile_is_the_hull_of_the_region_on_a_grid(fmu: FrictionFmu) -> None:
    """Every value with which some other makes the misfit small enough, without any search."""
    rows = read(identify.EXAMPLE, fmu, {})
    named = [parameter(fmu, name, None, None, {}) for name in ("contact.stiffnessScale", "vibration.phase_d")]
    experiment = Rows(fmu, rows, named)
    result = fit(experiment)
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
    assert f"only from above ({most:.0f} MN/m) and hardly bounds the phase ({low:.0f}° to {high:.0f}°)" in (
        " ".join(GUIDE.split())
    )


def test_warns_that_stiff_contacts_do_not_show_their_stiffness(fmu: FrictionFmu) -> None:
    forces = [27.0, 32.6, 39.3, 18.2]  # Coulomb's (2/pi) asin(V/V_1) within 0.2 N
    rows = Measurements(("V",), [{"V": V, "vibration.V_1": 1.0} for V in (0.7, 0.8, 0.9, 0.5)], forces, None)
    result = fit(Rows(fmu, rows, [parameter(fmu, "contact.stiffnessScale", 1.0, None, {})]))
    assert min(result.kappa) > 100.0
    assert any("says nearly nothing about contact.stiffnessScale" in text for text in result.warnings)
    assert any("the data can't tell contact.stiffnessScale" in text for text in result.warnings)


def test_warns_without_reversals(fmu: FrictionFmu) -> None:
    rows = Measurements(("V",), [{"V": V} for V in (0.1, 0.2, 0.3, 0.4)], [54.0, 55.0, 56.0, 55.0], None)
    named = [parameter(fmu, "F_C", 50.0, None, {}), parameter(fmu, "contact.stiffnessScale", 1e-6, None, {})]
    result = fit(Rows(fmu, rows, named))
    assert result.values[0] == pytest.approx(55.0, abs=1e-6)
    assert math.isinf(result.half_widths[1])
    assert any("no row has V < V_1" in text for text in result.warnings)


def test_warns_of_parameters_that_are_one(fmu: FrictionFmu) -> None:
    """Only the product of the two is in the model."""
    rows = Measurements(
        ("V",),
        [{"V": V, "vibration.V_1": 1.5} for V in (0.2, 0.5, 0.8, 1.1)],
        [11.0, 24.0, 33.0, 43.0],
        None,
    )
    named = [
        parameter(fmu, "contact.stiffnessScale", 1e-6, None, {}),
        parameter(fmu, "contact.eta", 47e9, None, {}),
    ]
    result = fit(Rows(fmu, rows, named))
    assert all("the data can't tell " + p.name in " ".join(result.warnings) for p in result.parameters)


HEADER = "V [mm/s],vibration.V_1 [m/s],F_t_mean [N]\n"
GOOD = "20,0.5,31\n40,0.5,33\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no header row"),
        ("V [m/s],vibration.V_1 [m/s]\n1,2\n", r"column 'F_t_mean \[N\]' is missing"),
        ("vibration.V_1 [m/s],F_t_mean [N]\n1,2\n", r"column 'V \[m/s\]' is missing"),
        ("V [m/s,F_t_mean [N]\n1,2\n", r"line 1, column 1: heading 'V \[m/s' is not of the form"),
        ("V [km],F_t_mean [N]\n1,2\n", "column 1: V takes a unit like m/s, not 'km'"),
        ("V [m/s],F_t_mean [kg]\n1,2\n", "column 2: F_t_mean takes a unit like N, not 'kg'"),
        (
            "V [m/s],speed [m/s],F_t_mean [N]\n",
            "column 2: speed is no variable that a table of measurements may hold; these",
        ),
        ("V [m/s],V [mm/s],F_t_mean [N]\n", "column 2: V is there twice"),
        (
            HEADER + GOOD + "nan,0.5,3\n",
            r"row 3 \(line 4\), column 'V \[mm/s\]': 'nan' is not a finite number",
        ),
        (HEADER + GOOD + "50,,3\n", r"row 3 \(line 4\), column 'vibration.V_1 \[m/s\]': no value"),
        (HEADER + GOOD + "50,0.5\n", r"row 3 \(line 4\), column 'F_t_mean \[N\]': no value"),
        (
            HEADER + "# a remark\n50,x,3\n",
            r"row 1 \(line 3\), column 'vibration.V_1 \[m/s\]': 'x' is not a number",
        ),
        (HEADER + "1,2,3,4\n", r"row 1 \(line 2\): 4 cells, but 3 columns; decimals have a point"),
        (HEADER + '0.1,"0,5",3\n', r"V_1 \[m/s\]': '0,5' is not a number; write 0.5"),
        ("V [m/s],load [N],d [um],F_t_mean [N]\n1,2,3,4\n", "load and d both give the separation"),
        (HEADER, "no rows of numbers"),
        (HEADER + GOOD + "50,0.5,-1e308\n", r"row 3 \(line 4\), column .*: -1e308 must be from -1e\+50 to"),
        (
            "V.uncertainty [m/s],V [m/s],F_t_mean [N]\n1,1,1\n",
            "the uncertainty of V can't be weighed without",
        ),
        ("d.uncertainty [m],V [m/s],F_t_mean [N]\n1,1,1\n", "d.uncertainty belongs to a column d"),
        ("V [m/s],F_t [N],F_t_mean [N]\n1,1,1\n", "F_t is for a series"),
        ("time [s],F_t [N]\n1,1\n", r"a series in time needs either 'position \[m\]' or 'V \[m/s\]'"),
        ("time [s],V [m/s]\n1,1\n", r"column 'F_t \[N\]' is missing"),
        ("time [s],V [m/s],F_t [N]\n1,1,1\n2,1,1\n2,1,1\n", "row 3: time must grow"),
        (
            "time [s],V [m/s],F_C [N],F_t [N]\n1,1,1,1\n2,1,1,1\n3,1,1,1\n",
            "column F_C: a series takes inputs",
        ),
        (
            "V [m/s],load [N],F_t_mean [N]\n1,-5,4\n",
            r"row 1 \(line 2\), column 'load \[N\]': -5 must be positive",
        ),
    ],
)
def test_bad_data_are_refused_by_row_and_column(
    fmu: FrictionFmu, tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(UserError, match=message):
        read(path, fmu, {})


def test_units_and_loads_are_converted(fmu: FrictionFmu, tmp_path: Path) -> None:
    path = tmp_path / "good.csv"
    path.write_text("V [mm/s],vibration.phase_d [deg],load [kN],F_t_mean [mN]\n20,180,0.31244152,31000\n")
    rows = read(path, fmu, {})
    assert rows.force == pytest.approx([31.0])
    assert rows.conditions == [
        {
            "V": pytest.approx(0.02),
            "vibration.phase_d": pytest.approx(math.pi),
            "load": pytest.approx(312.44152),
            "contact.input": "Load",
            "friction.limit": "Load",
        }
    ]
    assert read(path, fmu, {"friction.limit": "Constant"}).conditions[0]["friction.limit"] == "Constant"


def test_a_load_drives_limit_and_stiffness(fmu: FrictionFmu, tmp_path: Path) -> None:
    """Without vibration steady sliding is friction.mu times the load: a straight line through the rows."""
    path = tmp_path / "load.csv"
    path.write_text("V [m/s],load [N],F_t_mean [N]\n0.1,100,20.5\n0.1,200,39\n0.1,300,61\n")
    result = fit(Rows(fmu, read(path, fmu, {}), [parameter(fmu, "friction.mu", None, None, {})]))
    line = (100 * 20.5 + 200 * 39 + 300 * 61) / (100**2 + 200**2 + 300**2)
    assert result.values[0] == pytest.approx(line, rel=1e-6)


def test_warns_that_soft_contacts_do_not_show_their_stiffness(fmu: FrictionFmu) -> None:
    conditions = [{"V": V, "vibration.V_1": 1.0, "contact.model": "Constant"} for V in (0.2, 0.4, 0.6, 0.8)]
    forces = [
        55.0 * _soft_limit(row["V"]) + error
        for row, error in zip(conditions, (0.1, -0.1, 0.1, -0.1), strict=True)
    ]
    rows = Measurements(("V",), conditions, forces, [0.1] * 4)
    result = fit(Rows(fmu, rows, [parameter(fmu, "contact.sigma", None, (1e3, 1e9), {})]))
    assert max(result.kappa) < 0.1
    assert any("below 0.1 the mean friction says nearly nothing" in text for text in result.warnings)
    assert any(
        "the data can't tell contact.sigma: within 95 % it is at most" in text for text in result.warnings
    )


def _soft_limit(zeta: float) -> float:
    """zeta / <|zeta + cos|>"""
    t = 2.0 * np.pi * (np.arange(100_000) + 0.5) / 100_000
    return zeta / float(np.mean(np.abs(zeta + np.cos(t))))


def test_misfit_is_said_first(fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "misfit.csv"
    path.write_text("V [m/s],vibration.V_1 [m/s],F_t_mean [N]\n0.1,1,10\n0.2,1,40\n0.3,1,5\n")
    main(
        identify,
        [str(path), "--fmu", str(fmu_path), "--quick", "--fit", "F_C=30", "--uncertain", "F_t_mean=0.5"],
    )
    assert capsys.readouterr().out.startswith("MISFIT: the law does not fit: the misfit, ")


def test_profile_of_a_parabola_is_the_linear_interval(fmu: FrictionFmu) -> None:
    """friction.sigma_2 adds sigma_2 V to the mean: linear, and zero may be the truth."""
    conditions = [{"V": V, "friction.limit": "Constant"} for V in (0.5, 1.0, 1.5, 2.0)]
    rows = Measurements(("V",), conditions, [60.1, 64.8, 70.2, 74.9], [0.2] * 4)
    result = fit(Rows(fmu, rows, [parameter(fmu, "friction.sigma_2", None, (0.0, 100.0), {})]))
    V, F = np.array([0.5, 1.0, 1.5, 2.0]), np.array([60.1, 64.8, 70.2, 74.9]) - 55.0
    half = 1.959964 * 0.2 / math.sqrt(V @ V)
    expected = (V @ F / (V @ V) - half, V @ F / (V @ V) + half)
    assert result.interval(0) == pytest.approx(expected, rel=1e-5)
    assert result.profiles[0] == pytest.approx(expected, rel=1e-3)


def test_errors_of_inputs_widen_the_interval_by_their_share(fmu: FrictionFmu) -> None:
    """F = F_C + sigma_2 V: an error u of V acts as an error sigma_2 u of the force."""
    conditions = [{"V": V, "friction.sigma_2": 10.0} for V in (0.5, 1.0, 1.5, 2.0)]
    forces = [60.1, 64.8, 70.2, 74.9]
    uncertain = tuple(Uncertain("V", 0.03, k) for k in range(4))
    rows = Measurements(("V",), conditions, forces, [0.2] * 4, uncertain)
    result = fit(Rows(fmu, rows, [parameter(fmu, "F_C", 50.0, None, {})]))
    deviation = math.sqrt((0.2**2 + 0.3**2) / 4.0)
    mean = np.mean(np.array(forces) - 10.0 * np.array([0.5, 1.0, 1.5, 2.0]))
    expected = [mean * math.exp(sign * 1.959964 * deviation / mean) for sign in (-1.0, 1.0)]
    assert result.interval(0) == pytest.approx(expected, rel=1e-5)
    shared = replace(rows, uncertain=(Uncertain("V", 0.03, None),))
    result = fit(Rows(fmu, shared, [parameter(fmu, "F_C", 50.0, None, {})]))
    deviation = math.sqrt(0.2**2 / 4.0 + 0.3**2)
    expected = [mean * math.exp(sign * 1.959964 * deviation / mean) for sign in (-1.0, 1.0)]
    assert result.interval(0) == pytest.approx(expected, rel=1e-5)


def test_bootstrap_of_a_mean(fmu: FrictionFmu) -> None:
    """F_C from steady sliding is the rows' mean: its refits scatter by u / sqrt(rows)."""
    rows = Measurements(("V",), [{"V": 0.1}] * 4, [54.0, 55.0, 56.0, 55.0], [1.0] * 4)
    experiment = Rows(fmu, rows, [parameter(fmu, "F_C", 50.0, None, {})])
    spread = np.exp(bootstrap(experiment, fit(experiment), 200)[:, 0])
    assert np.mean(spread) == pytest.approx(55.0, abs=4 * 0.5 / math.sqrt(200))
    assert np.std(spread) == pytest.approx(0.5, rel=4 / math.sqrt(2 * 200))


def test_dry_rows_are_the_validation_s(fmu: FrictionFmu) -> None:
    """The example file holds the published rows; the fit is the one that scripts/validate finds otherwise."""
    rows = read(
        ROOT / "data" / "dry.csv", fmu, {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
    )
    published = sliding("dry")
    assert rows.force == pytest.approx(list(published.vibrated))
    assert [row["F_C"] for row in rows.conditions] == pytest.approx(list(published.without))
    assert [row["V"] for row in rows.conditions] == pytest.approx(list(published.V))
    assert [row["vibration.V_1"] for row in rows.conditions] == pytest.approx([published.V_1] * 5)
    assert [row["vibration.f"] for row in rows.conditions] == pytest.approx([published.f] * 5)
    result = fit(Rows(fmu, rows, [parameter(fmu, "contact.sigma", None, None, {})]))
    expected = longitudinal.fit(fmu.path, published, "ElasticPlastic").stiffness
    assert result.values[0] == pytest.approx(expected, rel=2e-3)
    low, high = (1e-6 * end for end in result.profiles[0])
    assert f"{1e-6 * result.values[0]:.2f} MN/m ({low:.2f} to {high:.2f})" in GUIDE


def test_the_stated_uncertainty_decides_whether_the_dry_rows_reject_the_law() -> None:
    """As page 2 of the tutorial says of ElasticPlastic."""
    page = " ".join((ROOT / "docs" / "tutorial" / "your-surface.md").read_text(encoding="utf-8").split())
    assumed, smaller = 0.05, 0.03  # N
    assert f"we assume {assumed} N." in page and f"is not rejected. At {smaller} N it would be." in page
    law = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
    for uncertainty, faults in ((assumed, 0), (smaller, 1)):
        found = fc.identify(
            ROOT / "data" / "dry.csv", "contact.sigma", start=law, uncertain={"F_t_mean": uncertainty}
        )
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
    result = fit(Record(fmu, series, named))
    rms = math.sqrt(2.0 * expected.cost / len(series.force))
    assert result.values == pytest.approx([math.exp(expected.x[0]), expected.x[1]], rel=1e-3)
    assert np.sqrt(np.mean(result.residuals**2)) == pytest.approx(rms, rel=1e-4)
    times = rms / (np.std(np.diff(series.force, 2)) / math.sqrt(6.0))
    assert f"{times:.3g} times the scatter" in result.misfits[0]
    page = " ".join(GUIDE.split())
    assert f"{1e-6 * result.values[0]:.4f} MN/m and {result.values[1]:.3f}" in page
    assert f"a misfit of {rms:.2f} N, {times:.0f} times the scatter" in page


STUCK = {"friction.model": "ElasticPlastic", "friction.staticRatio": 1.5, "friction.V_S": 0.01}
DAMPED = {"friction.model": "ElasticPlastic", "friction.sigma_1": 500.0, "friction.sigma_2": 300.0}


@pytest.mark.parametrize(
    ("scene", "V", "f", "first", "fitted", "column"),
    [
        pytest.param(STUCK | {"delta_0": 65.0 / 4e6}, 0.02, 1e3, 0, (), "V", id="stuck above F_C"),
        pytest.param({"vibration.V_1": 0.3, "vibration.f": 2e4}, 0.1, 1e3, 13, (), "V", id="vibration"),
        pytest.param(DAMPED, 0.05, 100.0, 0, ("friction.sigma_1", "friction.sigma_2"), "V", id="damping"),
        pytest.param(DAMPED, 0.05, 100.0, 9, ("friction.sigma_1",), "position", id="position"),
    ],
)
def test_what_simulate_writes_gives_the_truth(
    fmu_path: Path, scene: dict, V: float, f: float, first: int, fitted: tuple[str, ...], column: str
) -> None:
    """V sin(2 pi f t), 80 samples a period; a position is the integral of V."""
    scene = {"contact.model": "Constant", "F_C": 50.0, "contact.sigma": 4e6} | scene
    time = np.arange(161) / (80.0 * f)
    drive = {"time": time, "V": V * np.sin(2.0 * np.pi * f * time)}
    data = fc.simulate(scene, stop=time[-1], step=time[1], inputs=drive, outputs=["V", "F_t"], fmu=fmu_path)
    if column == "position":
        data["V"] = V * (1.0 - np.cos(2.0 * np.pi * f * time)) / (2.0 * np.pi * f)
        data = data.rename(columns={"V": "position"})
    fit = ("contact.sigma", *fitted)
    start = {name: value for name, value in scene.items() if name not in (*fit, "delta_0")}
    found = fc.identify(data[first:], fit, start=start, fmu=fmu_path)
    assert list(found.values.values()) == pytest.approx([scene[name] for name in fit], rel=0.002)


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["--fit", "F_C", "--fit", "vibration.V_1"], "vibration.V_1 is a column of the measurements"),
        (["--fit", "F_C", "--fit", "contact.eta", "--fit", "d"], "2 rows can't give 3 parameters"),
        (["--fit", "sigma"], "sigma can't be fitted; did you mean contact.sigma. these"),
        (["--fit", "F_C=-3"], r"F_C = -3 N must be from 1e-12"),
        (["--fit", "F_C=3..2"], "the range is empty"),
        (
            ["--fit", "F_C", "--set", "friction.model=Stribeck"],
            "friction.model: 'Stribeck' is not one of Dahl, Coulomb",
        ),
        (["--fit", "F_C", "--set", "F_C=50"], "F_C is given as a start value"),
        (["--fit", "F_C", "--set", "vibration.a_d=20e-6"], "row 1: .*"),
        (["--fit", "F_C=1e308"], r"F_C = 1e\+308 N must be from 1e-12 to 1e\+50"),
        (["--fit", "friction.sigma_2=1e308"], r"friction.sigma_2 = 1e\+308 N.s/m must be from 0 to"),
        (["--fit", "F_C", "--uncertain", "F_t_mean=1e-308"], r"F_t_mean, 1e-308: must be from 1e-50 to"),
    ],
)
def test_bad_requests_are_refused(fmu_path: Path, tmp_path: Path, argv: list[str], message: str) -> None:
    path = tmp_path / "good.csv"
    path.write_text(HEADER + GOOD)
    with pytest.raises(SystemExit, match=f"error: .*{message}"):
        main(identify, [str(path), "--fmu", str(fmu_path), "--output", str(tmp_path), *argv])


def test_a_part_of_nothing_is_no_uncertainty(fmu_path: Path, tmp_path: Path) -> None:
    path = tmp_path / "zero.csv"
    path.write_text(HEADER + GOOD + "50,0.5,0\n")
    with pytest.raises(
        SystemExit, match="error: the uncertainty of F_t_mean: row 3 measures 0 N, so give it in N"
    ):
        main(identify, [str(path), "--fmu", str(fmu_path), "--fit", "F_C", "--uncertain", "F_t_mean=5%"])


@pytest.mark.parametrize("table", ["V,F_t_mean\n0.1,0\n0.2,0\n", "time,V,F_t\n0,1,0\n1,1,0\n2,1,0\n"])
def test_no_force_at_all_is_refused(fmu_path: Path, tmp_path: Path, table: str) -> None:
    path = tmp_path / "zero.csv"
    path.write_text(table)
    with pytest.raises(UserError, match="every measured force is 0 N"):
        fc.identify(path, "F_C", fmu=fmu_path)


@pytest.mark.parametrize("rise", [0.0, 0.25])
def test_a_record_without_scatter_is_judged(fmu_path: Path, rise: float) -> None:
    """Steady sliding, F_t = F_C; a force that rises by 1/4 N from sample to sample is another law."""
    k = np.arange(41)
    data = pd.DataFrame({"time": 1e-4 * k, "V": 0.1, "F_t": 40.0 + rise * k})
    start = {"contact.model": "Constant", "contact.sigma": 1e9}
    found = fc.identify(data, "F_C", start=start, fmu=fmu_path)
    assert found.values["F_C"] == pytest.approx(np.mean(data.F_t), rel=1e-6 if rise == 0.0 else 0.01)
    assert len(found.misfits) == (rise > 0.0)
    assert all("is more than the scatter of neighbouring samples, 0 N" in text for text in found.misfits)


LUGRE_FIT = """\
V [m/s],vibration.V_1 [m/s],F_t_mean [N]
0.05,0.3,11.55820
0.05,0.7,4.52370
0.05,1.0,1.70537
0.05,1.4,1.72025
0.2,0.3,41.07692
0.2,0.7,17.34585
0.2,1.0,10.23799
0.2,1.4,7.45943
0.6,0.3,48.94052
0.6,0.7,45.38829
0.6,1.0,31.98240
0.6,1.4,21.26580
"""


def test_a_fit_of_four_parameters_ends_and_says_what_the_data_leave_open(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """scipy's differential evolution finds a sum of squares of 15.155 in the same ranges: no less."""
    path = tmp_path / "lugre.csv"
    path.write_text(LUGRE_FIT)
    ranges = ("contact.sigma=1e4..1e9", "F_C", "friction.staticRatio=1..3", "friction.V_S=1e-3..1")
    main(identify,
        [
            str(path), "--fmu", str(fmu_path), "--quick", "--uncertain", "F_t_mean=0.5",
            "--set", "friction.model=LuGre", "--set", "contact.model=Constant",
            *(word for one in ranges for word in ("--fit", one)),
        ]
    )  # fmt: skip
    printed = capsys.readouterr().out
    assert float(re.search(r"misfit: (\S+) N rms over 12 rows", printed)[1]) <= 0.5 * math.sqrt(15.155 / 12)
    for name, low, high in (("friction.staticRatio", "1", "3"), ("friction.V_S", "0.001", "1 m/s")):
        assert f"the data can't tell {name}: within 95 % it may be anything from {low} to {high}" in printed
    assert "can't tell contact.sigma" not in printed


@pytest.mark.parametrize(
    ("V", "force", "said"),
    [
        (range(1, 9), range(8), "rows of neighbouring V are alike"),
        ((3, 8, 1, 5, 7, 2, 6, 4), range(8), "have the shape of a drift of the force"),
        ((3, 8, 1, 5, 7, 2, 6, 4), (2, 4, 0, 5, 1, 3, 7, 6), ""),
    ],
)
def test_differences_with_a_trend_are_a_misfit(
    fmu_path: Path, V: Sequence[int], force: Sequence[int], said: str
) -> None:
    """Of one force, F_C, at eight velocities: measured ones grow with V, from row to row, or with neither."""
    data = {"V [cm/s]": 10.0 * np.array(V), "F_t_mean": 50.0 + np.array(force)}
    misfits = fc.identify(data, "F_C", fmu=fmu_path).misfits
    assert len(misfits) == bool(said)
    assert all(said in text for text in misfits)


def test_scatter_is_seldom_suspicious() -> None:
    """Of 400 fits of a law that is right, at most so many as a chance of 1 % explains."""
    random = np.random.default_rng(1)
    V, V_1 = np.repeat(np.geomspace(0.01, 1.0, 6), 2), np.tile([0.0, 0.5], 6)
    conditions = [{"V": v, "vibration.V_1": a} for v, a in zip(V, V_1, strict=True)]
    rows = Measurements(("V", "vibration.V_1"), conditions, [0.0] * 12, None)
    slopes = np.stack([np.ones(12), V_1 * np.log(V)], axis=1)
    experiment = SimpleNamespace(rows=rows, word="row", weight=np.ones(12), force=np.full(12, 50.0))
    left = np.eye(12) - slopes @ np.linalg.pinv(slopes)
    told = 0
    for _ in range(400):
        result = SimpleNamespace(residuals=left @ random.standard_normal(12), slopes=slopes)
        told += suspicion(experiment, result, {"of a drift": np.arange(12.0)})[0] < CHANCE
    assert told <= stats.binom.ppf(0.99, 400, CHANCE)


def test_an_interval_that_the_data_do_not_determine_is_not_printed(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "rows.csv"
    path.write_text("V,F_t_mean\n0.5,55\n0.6,55.2\n0.7,54.9\n")
    main(identify, [str(path), "--fmu", str(fmu_path), "--quick", "--fit", "contact.stiffnessScale"])
    (row,) = [line for line in capsys.readouterr().out.splitlines() if "stiffnessScale │" in line]
    assert [cell.strip() for cell in row.split("│")][-3:-1] == ["not determined"] * 2


def test_command_prints_and_draws(fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(identify, ["--fmu", str(fmu_path), "--output", str(tmp_path)])
    printed = capsys.readouterr().out
    assert "contact.stiffnessScale" in printed
    assert "224.6" in printed
    assert (tmp_path / "identify.png").stat().st_size > 10_000
    assert (tmp_path / "identify.svg").is_file()
