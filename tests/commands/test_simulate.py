"""fc.simulate and its command: the reference's numbers wherever samples lie; one line for what is wrong."""

from __future__ import annotations

import os
import re
from itertools import chain
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import frictioncontact as fc
from frictioncontact.command import main
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.simulation import command
from workshop.reference import changed, follow, scene_of

SOFT: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": 2.5e6, "solver.tolerance": 1e-8}
STEP, COUNT = 3e-5, 8
# Uneven samples: before the first row, at a row, between rows, a jump, and none over the last rows.
TIME = [-1e-5, 1.3e-5, 3e-5, 3.7e-5, 9.1e-5, 9.1e-5, 1.6e-4]
VELOCITY = [0.1, 0.4, -0.2, 0.3, 0.5, -0.6, 0.2]


def pieces(time: list[float], values: list[float], end: float) -> list[tuple[float, float, float, float]]:
    """Begin, end, value at the begin and slope of each straight piece of the samples from 0 to end."""
    times, samples = [*time, max(end, time[-1]) + 1.0], [*values, values[-1]]
    if time[0] > 0.0:
        times, samples = [-1.0, *times], [values[0], *samples]
    found = []
    for a, b, left, right in zip(times[:-1], times[1:], samples[:-1], samples[1:], strict=True):
        begin, stop = max(a, 0.0), min(b, end)
        if stop > begin:
            slope = (right - left) / (b - a)
            found.append((begin, stop, left + slope * (begin - a), slope))
    return found


def right(values: dict[str, Value], time: list[float], velocity: list[float]) -> np.ndarray:
    """F_t and its mean over each of COUNT rows [N], by the reference over every straight piece."""
    scene, scenes = scene_of(values), []
    for k in range(COUNT):
        scenes.append([])
        for begin, end, value, slope in pieces(time, velocity, (k + 1) * STEP):
            at = max(begin, k * STEP)
            if end > at:
                scenes[-1].append(changed(scene, V=value + slope * (at - begin), V_rate=slope, h=end - at))
    steps, rows = iter(follow(chain(*scenes))), []
    for row in scenes:
        found = [next(steps) for _ in row]
        impulse = sum(each.F_t_mean * part.h for each, part in zip(found, row, strict=True))
        rows.append((found[-1].F_t, impulse / STEP))
    return np.array(rows)


@pytest.mark.parametrize("law", ["Dahl", "LuGre", "ElasticPlastic"])
@pytest.mark.parametrize("shift", [0.0, 2e-5], ids=["begins before", "begins after"])
def test_inputs_are_linear_between_samples_that_fall_anywhere(fmu_path: Path, law: str, shift: float) -> None:
    values = {**SOFT, "friction.model": law}
    time = [t + shift for t in TIME]
    got = fc.simulate(
        values, stop=COUNT * STEP, step=STEP, inputs={"time": time, "V": VELOCITY}, fmu=fmu_path
    )
    expected = right(values, time, VELOCITY)
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


def test_samples_inside_of_rows_add_no_rows(fmu_path: Path) -> None:
    """Whatever is read: as many rows as steps, with the force at their ends (Eq. 2)."""
    inputs = {"time": [0.0, 1e-5], "V": [0.3, 0.3]}
    table = fc.simulate(SOFT, stop=9e-5, step=3e-5, inputs=inputs, outputs=["F_t"], fmu=fmu_path)
    exact = -55.0 * np.expm1(-2.5e6 * 0.3 / 55.0 * np.arange(4) * 3e-5)
    assert table["F_t"].to_numpy() == pytest.approx(exact, abs=1e-6 * 55.0)


@pytest.mark.parametrize(("V", "mean"), [("V", "F_t_mean"), ("V_y", "F_y_mean")])
def test_the_mean_is_over_the_time_since_the_row_before(fmu_path: Path, V: str, mean: str) -> None:
    """With samples inside the rows: W_f / V at a constant V along one direction."""
    inputs = {"time": np.linspace(0.0, 1e-4, 8), V: np.full(8, 0.3)}
    scene = {**SOFT, "V": 0.0}
    table = fc.simulate(scene, stop=1e-4, step=5e-5, inputs=inputs, outputs=["W_f", mean], fmu=fmu_path)
    expected = np.diff(table["W_f"]) / 0.3 / 5e-5
    assert table[mean][1:].to_numpy() == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start": {"v": 1.0}}, "start: v is no variable of the FMU; did you mean V?"),
        ({"start": {"d": -1e-6}}, "fmi2ExitInitializationMode: d = -1e-06 m must be above 0 m"),
        ({"outputs": ["F_tt"]}, "outputs: F_tt is no variable of the FMU; did you mean F_t?"),
        (
            {"outputs": ["friction.model"]},
            "outputs: friction.model is of type Enumeration; only Real is read",
        ),
        ({"stop": 0.0}, "stop = 0.0: must be a positive number of seconds"),
        ({"step": 1e-12}, "step = 1e-12 s: stop / step must be at most"),
        ({"inputs": {"V": [1.0]}}, "inputs: needs a column time [s] and at least one of V, d, E, load"),
        ({"inputs": {"time": [0.0], "F_C": [1.0]}}, "inputs: F_C is no input of the FMU; these are: V, d"),
        ({"inputs": {"time": [0.0, 1.0], "V": [1.0]}}, "inputs: V has 1 values and time has 2"),
        ({"inputs": {"time": [0.0, 1.0], "V": [-1e308, 1e308]}}, "inputs: V, row 0: -1e+308 must be"),
        ({"stop": True}, "stop = 'True' is not a number"),
        ({"inputs": {"time": [1.0, 0.5], "V": [1.0, 1.0]}}, "inputs: time falls from 1 to 0.5 s at sample 1"),
        ({"inputs": {"time": [], "V": []}}, "inputs: no samples"),
        ({"inputs": {"time": np.array(["2026-01-01"], "M8[s]"), "V": [1.0]}}, "inputs: time, row 0: "),
        ({"inputs": {"time": [0.0], "V": np.ma.array([1.0], mask=[True])}}, "inputs: V, row 0: is masked"),
        ({"inputs": "drive.csv"}, "drive.csv: No such file"),
        (
            {"inputs": 3.0},
            "inputs = '3.0': must be the path of a CSV file, a mapping of names to values, or a",
        ),
        ({"fmu": "absent.fmu"}, "absent.fmu: No such file"),
        ({"fmu": "."}, ".: Is a directory"),
        ({"start": [("V", 1.0)]}, "start = \"[('V', 1.0)]\": must be a mapping of names to values"),
        ({"outputs": "F_t"}, "outputs = 'F_t': must be a sequence of names"),
    ],
)
def test_what_is_wrong_is_named(fmu_path: Path, arguments: dict, message: str) -> None:
    with pytest.raises(fc.UserError, match="^(fmi2SetReal: )?" + re.escape(message)):
        fc.simulate(**{"stop": 1e-3, "step": 1e-4, "fmu": fmu_path, **arguments})


def test_a_refused_reading_has_the_fmu_s_own_words(fmu: FrictionFmu) -> None:
    with fmu.session({"friction.sigma_2": 1e300}) as session:
        session.set("V", 1e15)
        with pytest.raises(fc.FrictionError, match="is beyond the largest number"):
            session.get("F_t_settled")
        with pytest.raises(fc.FrictionError, match="is beyond the largest number"):
            session.read(["F_t", "F_t_settled"])


def test_the_command_prints_or_writes_the_same_table(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--set", "V=0.5", "--set", "friction.model=LuGre", "--stop", "1e-3", "--step", "5e-4"]
    main(command, [*words, "--outputs", "F_t", "W_f", "--fmu", str(fmu_path)])
    printed = capsys.readouterr().out.splitlines()
    main(
        command,
        [*words, "--outputs", "F_t", "W_f", "--fmu", str(fmu_path), "--output", str(tmp_path / "out.csv")],
    )
    written = pd.read_csv(tmp_path / "out.csv")
    table = fc.simulate(
        {"V": 0.5, "friction.model": "LuGre"}, stop=1e-3, step=5e-4, outputs=["F_t", "W_f"], fmu=fmu_path
    )
    pd.testing.assert_frame_equal(written, table, check_exact=True)
    assert printed[0].split() == ["time", "[s]", "F_t", "[N]", "W_f", "[J]"] and len(printed) == 4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time,V\n0,0.1\n1e-5,x\n", "row 2 (line 3), column 'V': 'x' is not a number"),
        ("time,V\n0,0.1\n1e-5,1_0\n", "row 2 (line 3), column 'V': '1_0' is not a number"),
        ("time,V\n0,\uff11\uff10\n", "row 1 (line 2), column 'V': '\uff11\uff10' is not a number"),
        ("time [s],V [km]\n0,0.1\n", "line 1, column 2: V takes a unit like m/s, not 'km'"),
    ],
)
def test_wrong_files_of_inputs(fmu_path: Path, tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "drive.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SystemExit, match=re.escape(message)):
        main(command, ["--stop", "1", "--step", "1", "--inputs", str(path), "--fmu", str(fmu_path)])


def test_an_fmu_that_is_replaced_is_read_anew(fmu: FrictionFmu, fmu_path: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.fmu"
    copy.write_bytes(fmu_path.read_bytes())
    assert len(fc.simulate(stop=1e-3, step=1e-3, fmu=copy)) == 2
    copy.write_text("no archive")
    with pytest.raises(fc.UserError, match=r"copy\.fmu is not an FMU"):
        fc.simulate(stop=1e-3, step=1e-3, fmu=copy)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a named pipe")
def test_a_pipe_is_written_to_and_stays(fmu_path: Path, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    end = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    main(command, ["--stop", "1e-3", "--step", "1e-3", "--fmu", str(fmu_path), "--output", str(pipe)])
    assert os.read(end, 7) == b"time,F_"
    os.close(end)
    assert pipe.is_fifo() and list(tmp_path.iterdir()) == [pipe]
