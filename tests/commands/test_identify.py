"""scripts/identify: it recovers what made the data, says what they can't tell, refuses what is no data."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from frictionlab.fmu import FrictionFmu
from frictionlab.identify import command as identify
from frictionlab.identify.data import Measurements, read
from frictionlab.identify.fit import Experiment, Fit, fit, parameter
from frictionlab.identify.recovery import NOISE, TRUTH, fits, held, measurements, true_forces
from frictionlab.parameters import STIFFNESS_PRINTED
from frictionlab.project import UserError

SEEDS = 100


@pytest.mark.parametrize(
    "uncertainty",
    [None, pytest.param([NOISE] * 12, marks=pytest.mark.slow)],
    ids=["scatter estimated", "uncertainty stated"],
)
def test_intervals_hold_the_truth_in_about_95_of_100_seeds(
    fmu: FrictionFmu, uncertainty: list[float] | None
) -> None:
    """Of 100 intervals of 95 %, 87 to 100 hold the truth with a probability of 99.9 %."""
    found = list(fits(fmu, SEEDS, uncertainty))
    for name in TRUTH:
        assert 87 <= held(found, name) <= SEEDS, name
    joint = sum(_inside_joint_region(one, uncertainty is not None) for one in found)
    assert 87 <= joint <= SEEDS


def _inside_joint_region(one: Fit, known: bool) -> bool:
    n = len(one.parameters)
    away = one.coordinates - np.array([p.to_coordinate(TRUTH[p.name]) for p in one.parameters])
    distance = float(away @ np.linalg.solve(one.covariance, away))
    return distance <= (stats.chi2.ppf(0.95, n) if known else n * stats.f.ppf(0.95, n, one.degrees))


def test_exact_data_give_the_truth_from_no_start_value(fmu: FrictionFmu) -> None:
    named = [parameter(fmu, name, None, None, {}) for name in TRUTH]
    with Experiment(fmu, measurements(true_forces(fmu)), named) as experiment:
        result = fit(experiment)
    assert result.values == pytest.approx(list(TRUTH.values()), rel=1e-5)


def test_fixed_parameter_is_fitted_too(fmu: FrictionFmu) -> None:
    rows = Measurements(
        ("V",), [{"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 5e-7}], [20.0], [0.1]
    )
    with Experiment(fmu, rows, [parameter(fmu, "contact.R_q", 6e-6, None, {})]) as experiment:
        result = fit(experiment)
    assert result.model == pytest.approx([20.0], abs=1e-4)


def test_table_2_example(fmu: FrictionFmu) -> None:
    """The least-squares solution leaves less than the equal-error one of the paper set, (0.56 N)^2 each."""
    rows = read(identify.EXAMPLE, fmu, {})
    named = [parameter(fmu, name, None, None, {}) for name in ("contact.stiffnessScale", "vibration.phase_d")]
    with Experiment(fmu, rows, named) as experiment:
        result = fit(experiment)
    assert result.values[0] * STIFFNESS_PRINTED == pytest.approx(2.383e6, rel=1e-3)
    assert math.degrees(result.values[1]) == pytest.approx(224.69, abs=0.05)
    assert np.sum(result.residuals**2) < 3 * 0.557**2
    assert any("an identification, not a validation" in text for text in result.warnings)
    assert any("another solution" in text for text in result.warnings)


def test_warns_that_stiff_contacts_do_not_show_their_stiffness(fmu: FrictionFmu) -> None:
    forces = [27.0, 32.6, 39.3, 18.2]  # Coulomb's (2/pi) asin(V/V_1) within 0.2 N
    rows = Measurements(("V",), [{"V": V, "vibration.V_1": 1.0} for V in (0.7, 0.8, 0.9, 0.5)], forces, None)
    with Experiment(fmu, rows, [parameter(fmu, "contact.stiffnessScale", 1.0, None, {})]) as experiment:
        result = fit(experiment)
    assert min(result.kappa) > 100.0
    assert any("says nearly nothing about contact.stiffnessScale" in text for text in result.warnings)
    assert any("the data can't tell contact.stiffnessScale" in text for text in result.warnings)


def test_warns_without_reversals(fmu: FrictionFmu) -> None:
    rows = Measurements(("V",), [{"V": V} for V in (0.1, 0.2, 0.3, 0.4)], [54.0, 55.0, 56.0, 55.0], None)
    named = [parameter(fmu, "F_C", 50.0, None, {}), parameter(fmu, "contact.stiffnessScale", 1e-6, None, {})]
    with Experiment(fmu, rows, named) as experiment:
        result = fit(experiment)
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
    with Experiment(fmu, rows, named) as experiment:
        result = fit(experiment)
    assert all("the data can't tell " + p.name in " ".join(result.warnings) for p in result.parameters)


HEADER = "V [mm/s],vibration.V_1 [m/s],F_t_mean [N]\n"
GOOD = "20,0.5,31\n40,0.5,33\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no header row"),
        ("V [m/s],vibration.V_1 [m/s]\n1,2\n", r"column 'F_t_mean \[N\]' is missing"),
        ("vibration.V_1 [m/s],F_t_mean [N]\n1,2\n", r"column 'V \[m/s\]' is missing"),
        ("V,F_t_mean [N]\n1,2\n", "line 1, column 1: heading 'V' is not of the form"),
        ("V [km/h],F_t_mean [N]\n1,2\n", "column 1: V is in m/s or mm/s, not in 'km/h'"),
        ("V [m/s],F_t_mean [kg]\n1,2\n", "column 2: F_t_mean is in N or mN or kN, not in 'kg'"),
        ("V [m/s],speed [m/s],F_t_mean [N]\n", "column 2: there is no variable 'speed'"),
        ("V [m/s],V [mm/s],F_t_mean [N]\n", "column V is there twice"),
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
        (HEADER + "1,2,3,4\n", r"row 1 \(line 2\): 4 cells, but 3 columns"),
        ("V [m/s],load [N],d [um],F_t_mean [N]\n1,2,3,4\n", "load and d both give the separation"),
        (
            "V [m/s],load [N],F_t_mean [N]\n1,1e9,4\n",
            r"row 1, column 'load': load = 1e\+09 N is out of reach",
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
    expected = {"V": 0.02, "vibration.phase_d": math.pi, "d": 14e-6}
    assert rows.conditions[0] == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["--fit", "F_C", "--fit", "vibration.V_1"], "vibration.V_1 is a column of the measurements"),
        (["--fit", "F_C", "--fit", "contact.eta", "--fit", "d"], "2 rows can't give 3 parameters"),
        (["--fit", "sigma"], "sigma can't be fitted; these can: V, d, E, F_C"),
        (["--fit", "F_C=-3"], r"F_C = -3 N must be from 1e-12"),
        (["--fit", "F_C=3..2"], "the range is empty"),
        (
            ["--fit", "F_C", "--set", "friction.model=Stribeck"],
            "friction.model: 'Stribeck' is not one of Dahl, Coulomb",
        ),
        (["--fit", "F_C", "--set", "F_C=50"], "F_C is given by --set"),
        (["--fit", "F_C", "--set", "vibration.a_d=20e-6"], "row 1: .*"),
    ],
)
def test_bad_requests_are_refused(fmu_path: Path, tmp_path: Path, argv: list[str], message: str) -> None:
    path = tmp_path / "good.csv"
    path.write_text(HEADER + GOOD)
    with pytest.raises(SystemExit, match=f"error: .*{message}"):
        identify.main([str(path), "--fmu", str(fmu_path), "--output", str(tmp_path), *argv])


def test_missing_file_is_named(fmu_path: Path) -> None:
    with pytest.raises(SystemExit, match=r"error: nowhere\.csv: No such file"):
        identify.main(["nowhere.csv", "--fmu", str(fmu_path)])


def test_command_prints_and_draws(fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    identify.main(["--fmu", str(fmu_path), "--output", str(tmp_path)])
    printed = capsys.readouterr().out
    assert "contact.stiffnessScale" in printed
    assert "224.6" in printed
    assert (tmp_path / "identify.png").stat().st_size > 10_000
    assert (tmp_path / "identify.svg").is_file()
