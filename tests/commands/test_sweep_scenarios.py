"""What scripts/sweep runs: grids, random draws and CSV files as the rows of a table; what it refuses."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.sweeps import run as command
from frictioncontact.sweeps.run import sweep
from frictioncontact.sweeps.scenarios import MAX_SCENARIOS, Vary, drawn, grid


def table(fmu_path: Path, folder: Path, *arguments: str) -> pd.DataFrame:
    """The scenarios of a sweep, as its results show them."""
    options = command.arguments(
        [*arguments, "--fmu", str(fmu_path), "--output", str(folder), "--samples", "1"]
    )
    swept = sweep(**command.wanted(options) | {"fresh": True})
    made = pd.read_parquet(swept.results)
    return made.loc[:, :"F_mean"].drop(columns=["scenario", "F_mean"])


def test_csv_with_units(fmu_path: Path, tmp_path: Path) -> None:
    path = tmp_path / "scenarios.csv"
    path.write_text(
        "V [mm/s],vibration.phase_d [deg],friction.model,vibration.a_d\n100,180,LuGre,1e-7\n\n1,0,Dahl,0\n"
    )
    made = table(fmu_path, tmp_path / "out", "--csv", str(path))
    assert made["friction.model"].tolist() == ["LuGre", "Dahl"]
    assert made["V"].tolist() == pytest.approx([0.1, 0.001]) and made["vibration.a_d"][0] == 1e-7
    assert made["vibration.phase_d"][0] == pytest.approx(np.pi, rel=1e-12)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("friction.model [mm]\n1\n", ", line 1, column 1: friction.model takes no unit, not 'mm'"),
        ("V,d\n0.1\n", ", row 1 (line 2), column 'd': no value"),
        (f"V\n{'1' * 131073}\n", ": is not a CSV file: field larger than field limit (131072)"),
        ("V\n", ": has no row below the header"),
    ],
)
def test_malformed_csv_names_row_and_column(
    fmu_path: Path, tmp_path: Path, content: str, message: str
) -> None:
    path = tmp_path / "scenarios.csv"
    path.write_text(content)
    with pytest.raises(UserError, match=re.escape(f"{path}{message}")):
        table(fmu_path, tmp_path / "out", "--csv", str(path))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("", "nothing to sweep"),
        ("--vary V", "--vary V: is not of the form NAME=VALUE"),
        ("--vary V=1:2", "'1:2' is neither low:high:count"),
        ("--vary V=2:1:3", "vary V: the range ends at 1, before it begins at 2"),
        ("--vary V=0:1:3:log", "must begin above 0"),
        ("--vary V=0:1:-3", "the count -3: must be a whole number from 1 to 10000000"),
        ("--vary V=1 --workers 0", "workers 0: must be a whole number from 1 to 1000"),
        ("--random 100001 --vary V=0:1 --group 1", "would be more than 100000 files"),
        ("--random 5 --vary V=0:1 --seed -1", "seed -1: must be a whole number from 0"),
        ("--csv none.csv --vary V=1", "csv does not go with vary"),
        ("--vary friction.model=1:4:4", "'1:4:4' is a range, but its values are names: Dahl,Coulomb"),
    ],
)
def test_wrong_arguments(fmu_path: Path, tmp_path: Path, arguments: str, message: str) -> None:
    options = command.arguments(
        [*arguments.split(), "--fmu", str(fmu_path), "--output", str(tmp_path / "out")]
    )
    with pytest.raises(UserError, match=re.escape(message)):
        command.run(options)
    assert not (tmp_path / "out").exists()


GRID: Vary = {"V": "0.01:1:24999:log", "d": "12e-6:16e-6:20000", "friction.model": "Dahl,Coulomb"}
RANDOM: Vary = {"V": "0.01:1:log", "d": "12e-6:16e-6", "friction.model": "Dahl,Coulomb"}


@pytest.mark.parametrize("random", [False, True])
def test_a_row_of_a_thousand_million_depends_on_its_number_alone(fmu: FrictionFmu, random: bool) -> None:
    made = drawn(fmu.known, RANDOM, MAX_SCENARIOS, 7) if random else grid(fmu.known, GRID)
    assert made.count == (MAX_SCENARIOS if random else 24999 * 20000 * 2)
    for place in (0, 39_999, 123_456_789, made.count - 40):
        whole = pd.DataFrame(made.rows(place, place + 40))
        for first, stop in ((0, 1), (3, 17), (17, 40)):
            piece = pd.DataFrame(made.rows(place + first, place + stop))
            assert piece.equals(whole[first:stop].reset_index(drop=True))
    if not random:
        last = {name: value[0] for name, value in made.rows(made.count - 1, made.count).items()}
        assert last == {"V": 1.0, "d": 16e-6, "friction.model": "Coulomb"}
        return
    # Each variable's draws are those of a stream of its own.
    streams = [np.random.default_rng(np.random.SeedSequence(7, spawn_key=(k,))) for k in range(3)]
    u = [stream.random(100_000) for stream in streams]
    drew = made.rows(0, 100_000)
    assert np.allclose(drew["V"], 0.01 ** (1.0 - u[0]), rtol=1e-12, atol=0.0)
    assert np.allclose(drew["d"], 12e-6 + 4e-6 * u[1], rtol=1e-12, atol=0.0)
    assert np.array_equal(drew["friction.model"], np.where(u[2] < 0.5, "Dahl", "Coulomb"))
    assert abs(np.corrcoef(u[0], u[1])[0, 1]) < 0.016  # 5 sigma


def test_values_from_python(fmu_path: Path, tmp_path: Path) -> None:
    """Sequences of numbers and of names, as `sweep` takes them beside the texts of the command."""
    swept = sweep(
        fmu=fmu_path, output=tmp_path / "out",
        vary={"V": np.array([0.1, 0.2]), "friction.model": ["Dahl", "LuGre"]},
        set={"vibration.V_1": 1.44}, samples=1, workers=1,
    )  # fmt: skip
    made = pd.read_parquet(swept.results)
    assert made["V"].tolist() == [0.1, 0.1, 0.2, 0.2]
    assert made["friction.model"].tolist() == ["Dahl", "LuGre"] * 2
    assert (swept.good, swept.refused, swept.new, swept.workers) == (4, 0, 4, 1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"vary": {"V": 0.3}}, "vary V: 0.3 is neither a text nor a sequence of values"),
        ({"vary": {"V": []}}, "vary V: has no values"),
    ],
)
def test_wrong_types_from_python_are_one_line(fmu_path: Path, arguments: dict, message: str) -> None:
    with pytest.raises(UserError, match="^" + re.escape(message)):
        sweep(**{"output": "nowhere", "fmu": fmu_path, **arguments})
    assert not Path("nowhere").exists()
