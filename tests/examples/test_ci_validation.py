"""The validation example: passes as it stands, fails when the model changes, names what its input lacks."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "examples" / "ci-validation"
HEADER = "scenario,start values,quantity,low,high,reason\n"


def validate(fmu: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [
        sys.executable,
        str(FOLDER / "validate.py"),
        "--fmu",
        str(fmu),
        "--picture",
        str(folder / "bands.png"),
    ]
    return subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=600)


def test_passes(fmu_path: Path, tmp_path: Path) -> None:
    done = validate(fmu_path, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "9 of 9 results in their bands" in done.stdout
    assert (tmp_path / "bands.png").stat().st_size > 10_000


def test_fails_when_a_result_leaves_its_band(fmu_path: Path, tmp_path: Path) -> None:
    done = validate(fmu_path, tmp_path, "--start", "contact.R_q=6.1e-6")
    assert done.returncode == 1
    assert [line.split(" = ")[0] for line in done.stdout.splitlines() if line.startswith("LEFT")] == [
        "LEFT contact at rest: sigma",
        "LEFT contact at rest: A_r",
    ]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("one,V=0.5,F_t_mean,x,56,why", "row 2, column low: 'x' is not a number"),
        ("one,V,F_t_mean,54,56,why", "row 2, column start values: 'V' is not of the form NAME=VALUE"),
        ("one,V=0.5,F_t_mean,54", "row 2: must have 6 cells"),
        ("one,v=0.5,F_t_mean,54,56,why", "v: no variable of FrictionContact.fmu"),
        ("one,d=-1,F_t_mean,54,56,why", "the FMU refused a call: fmi2SetReal: d = -1 m is below its minimum"),
    ],
)
def test_wrong_input_is_one_line(fmu_path: Path, tmp_path: Path, line: str, message: str) -> None:
    bands = tmp_path / "bands.csv"
    bands.write_text(HEADER + line + "\n")
    done = validate(fmu_path, tmp_path, "--bands", str(bands))
    assert done.returncode == 1
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert done.stderr.startswith("error: ") and message in done.stderr
