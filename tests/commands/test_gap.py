"""scripts/gap: what it prints and refuses."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from frictioncontact import gap
from frictioncontact.command import main
from frictioncontact.fmu import FrictionFmu
from frictioncontact.gap import load
from frictioncontact.parameters import Surfaces


@pytest.mark.parametrize("given", ["", "--set contact.R_q=4e-6 --set contact.nu=0 --set E=4e10"])
def test_load_gives_start_values_that_carry_it(
    fmu: FrictionFmu, capsys: pytest.CaptureFixture[str], given: str
) -> None:
    main(gap, ["--load", "100", *given.split()])
    words = capsys.readouterr().out.split("start values: ")[1].split()
    with fmu.session({name: float(value) for name, value in zip(words[::2], words[1::2], strict=True)}) as it:
        assert it.get("F_n") == pytest.approx(100.0, rel=1e-6)


def test_what_it_prints(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """A_r / A_n is A_r(14 um) e^(3 (14 - d) / 6) / A_n: 1 at d = 3.479 um."""
    monkeypatch.setenv("COLUMNS", "0")  # a terminal without width shows the table
    main(gap, ["--separation", "3.48e-6", "14e-6", "--set", "contact.R_q=6e-6"])
    printed = capsys.readouterr().out
    assert f"{load(Surfaces(), 14e-6):.4g}" in printed and "A_r [mm2]" in printed
    assert "warning" not in printed
    main(gap, ["--separation", "1e-6", "3.47e-6", "14e-6"])
    assert "warning: up to d = 3.4700 um the real area A_r is larger" in capsys.readouterr().out
    main(gap, ["--load", "100", "--heights", "gaussian"])
    assert "\nno start values: the FMU's heights are exponential" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--load -1", "--load -1: must be a positive number"),
        ("--load 1 --set contact.R_q=0", "--set contact.R_q 0: must be a positive number"),
        ("--load 1 --set contact.nu=0.6", "--set contact.nu=0.6: must be from 0 to 0.5"),
        ("--load 1e9", r"load = 1e\+09 N is out of reach"),
    ],
)
def test_values_out_of_bounds_are_refused(words: str, message: str) -> None:
    with pytest.raises(SystemExit, match=f"error: {message}"):
        main(gap, words.split())


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
def test_full_standard_output_is_named() -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-P", "-m", "tools", "frictioncontact.gap"]
        ran = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (1, "error: standard output: No space left on device\n")


def test_a_reader_that_has_seen_enough_is_no_error() -> None:
    """As `| head -1` reads."""
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-P", "-m", "tools", "frictioncontact.gap"]
    ran = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert ran.stderr == ""
