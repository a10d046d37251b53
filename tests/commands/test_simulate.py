"""fc.simulate and its command: the reference's numbers wherever samples lie; one line for what is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import frictioncontact as fc
from frictioncontact import simulation as command
from frictioncontact.command import main
from frictioncontact.fmu import Value

SOFT: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 2.5e6, "solver.tolerance": 1e-8}
STEP, COUNT = 3e-5, 8
# Uneven samples: before the first row, at a row, between rows, a jump, and none over the last rows.
TIME = [-1e-5, 1.3e-5, 3e-5, 3.7e-5, 9.1e-5, 9.1e-5, 1.6e-4]
VELOCITY = [0.1, 0.4, -0.2, 0.3, 0.5, -0.6, 0.2]


def right(law: str, time: list[float]) -> np.ndarray:
    """F_t and its mean over each of COUNT rows [N]: Eq. 2, or a spring with a bound, over small steps."""
    fine = 3000  # of a row, at whose ends every sample lies
    h, forces = STEP / fine, [0.0]
    for V in np.interp((np.arange(COUNT * fine) + 0.5) * h, time, VELOCITY):
        x, F = V * h, forces[-1]
        end = np.copysign(55.0, x)
        dahl = end + (F - end) * np.exp(-2.5e6 * abs(x) / 55.0)
        forces.append(dahl if law == "Dahl" else float(np.clip(F + 2.5e6 * x, -55.0, 55.0)))
    means = (0.5 * (np.array(forces[1:]) + forces[:-1])).reshape(COUNT, fine).mean(axis=1)
    return np.stack([forces[fine::fine], means], axis=1)


@pytest.mark.parametrize(("law", "shift"), [("Dahl", 0.0), ("ElasticPlastic", 2e-5)])
def test_inputs_are_linear_between_samples_that_fall_anywhere(fmu_path: Path, law: str, shift: float) -> None:
    time = [t + shift for t in TIME]
    scene, drive = {**SOFT, "friction.model": law}, {"time": time, "V": VELOCITY}
    got = fc.simulate(scene, stop=COUNT * STEP, step=STEP, inputs=drive, fmu=fmu_path)
    expected = right(law, time)
    assert got["F_t"][1:].to_numpy() == pytest.approx(expected[:, 0], abs=1e-6 * 55.0)
    assert got["F_t_mean"][1:].to_numpy() == pytest.approx(expected[:, 1], abs=1e-6 * 55.0)


def test_a_frame_of_inputs_and_a_last_row_that_is_shorter(fmu_path: Path) -> None:
    """A constant sigma and V: F = F_C (1 - exp(-sigma V t / F_C)), Eq. 2."""
    inputs = pd.DataFrame({"time": [0.0], "V": [0.3]})
    table = fc.simulate(SOFT, stop=1e-4, step=3e-5, inputs=inputs, outputs=["F_t"], fmu=fmu_path)
    assert list(table.columns) == ["time", "F_t"]
    assert table["time"].to_numpy() == pytest.approx([0.0, 3e-5, 6e-5, 9e-5, 1e-4], rel=1e-15)
    exact = -55.0 * np.expm1(-2.5e6 * 0.3 / 55.0 * table["time"].to_numpy())
    assert table["F_t"].to_numpy() == pytest.approx(exact, abs=1e-6 * 55.0)


def test_the_mean_is_over_the_time_since_the_row_before(fmu_path: Path) -> None:
    """With samples inside the rows, here across: W_f / V_y at a constant V_y."""
    inputs, scene = {"time": np.linspace(0.0, 1e-4, 8), "V_y": np.full(8, 0.3)}, {**SOFT, "V": 0.0}
    table = fc.simulate(scene, stop=1e-4, step=5e-5, inputs=inputs, outputs=["W_f", "F_y_mean"], fmu=fmu_path)
    expected = np.diff(table["W_f"]) / 0.3 / 5e-5
    assert table["F_y_mean"][1:].to_numpy() == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start": {"v": 1.0}}, "start: v is no variable of the FMU; did you mean V?"),
        ({"start": {"d": -1e-6}}, "fmi2ExitInitializationMode: d = -1e-06 m must be above 0 m"),
        ({"start": {"V": "5 mm/s"}}, "start: V: '5 mm/s' is not a number; write the number alone, in SI"),
        ({"outputs": ["F_tt"]}, "outputs: F_tt is no variable of the FMU; did you mean F_t?"),
        ({"outputs": ["friction.model"]}, "outputs: friction.model is of type Enumeration; only Real"),
        ({"outputs": "F_t"}, "outputs = 'F_t': must be a sequence of names"),
        ({"stop": 0.0}, "stop = 0.0: must be a positive number of seconds"),
        ({"step": 1e-12}, "step = 1e-12 s: stop / step must be at most"),
        ({"inputs": {"V": [1.0]}}, "inputs: needs a column time [s] and at least one of V, d, E, load"),
        ({"inputs": {"time": [0.0, 1.0], "V": [1.0]}}, "inputs: V has 1 values and time has 2"),
        ({"inputs": {"time": [0.0, 1.0], "V": [-1e308, 1e308]}}, "inputs: V, row 0: -1e+308 must be"),
        ({"inputs": {"time": [1.0, 0.5], "V": [1.0, 1.0]}}, "inputs: time falls from 1 to 0.5 s at sample 1"),
        ({"inputs": "drive.csv"}, "drive.csv: No such file"),
        ({"fmu": "."}, ".: Is a directory"),
    ],
)
def test_what_is_wrong_is_named(fmu_path: Path, arguments: dict, message: str) -> None:
    with pytest.raises(fc.UserError, match="^(fmi2SetReal: )?" + re.escape(message)):
        fc.simulate(**{"stop": 1e-3, "step": 1e-4, "fmu": fmu_path, **arguments})


def test_the_command_prints_or_writes_the_same_table(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--set", "V=0.5", "--set", "friction.model=LuGre", "--stop", "1e-3", "--step", "5e-4"]
    main(command, [*words, "--outputs", "F_t", "W_f", "--fmu", str(fmu_path)])
    printed = capsys.readouterr().out.splitlines()
    words += ["--output", str(tmp_path / "out.csv")]
    main(command, [*words, "--outputs", "F_t", "W_f", "--fmu", str(fmu_path)])
    written = pd.read_csv(tmp_path / "out.csv")
    table = fc.simulate(
        {"V": 0.5, "friction.model": "LuGre"}, stop=1e-3, step=5e-4, outputs=["F_t", "W_f"], fmu=fmu_path
    )
    pd.testing.assert_frame_equal(written, table, check_exact=True)
    assert printed[0].split() == ["time", "[s]", "F_t", "[N]", "W_f", "[J]"] and len(printed) == 4


def test_an_fmu_that_is_replaced_is_read_anew(fmu_path: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.fmu"
    copy.write_bytes(fmu_path.read_bytes())
    assert len(fc.simulate(stop=1e-3, step=1e-3, fmu=copy)) == 2
    copy.write_text("no archive")
    with pytest.raises(fc.UserError, match=r"copy\.fmu is not an FMU"):
        fc.simulate(stop=1e-3, step=1e-3, fmu=copy)
