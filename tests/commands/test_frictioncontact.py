"""The command `frictioncontact`, and the same commands from scripts/, which build first."""

from __future__ import annotations

import importlib
import subprocess
import sys

import pytest

from frictioncontact import __main__ as entry
from frictioncontact import command, gap, simulation
from frictioncontact.identification import command as identify
from tools import __main__ as clone
from tools import build


def test_help_says_what_it_is_called(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, (module, _) in entry.COMMANDS.items():
        for called in (None, "scripts/other") if module else ():
            monkeypatch.setattr(command, "called_as", called)
            with pytest.raises(SystemExit, match=r"^0$"):
                importlib.import_module(f"frictioncontact.{module}").arguments(["--help"])
            text = capsys.readouterr().out
            assert text.startswith(f"usage: {called or f'frictioncontact {name}'} ")
            assert (f"frictioncontact {name}" if called else "scripts/") not in text


def test_scripts_build_before_unless_an_fmu_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """And refuse wrong arguments before they build."""
    built = []
    monkeypatch.setattr(build, "build_fmu", lambda: built.append("built"))
    monkeypatch.setattr(command, "called_as", None)
    for arguments, builds in ((["--fmu", "mine.fmu"], 0), ([], 1)):
        monkeypatch.setattr(sys, "argv", ["identify", *arguments])
        clone.prepare(identify, "identification")
        assert len(built) == builds
        assert command.called_as == "scripts/identify"
    monkeypatch.setattr(sys, "argv", ["identify", "--nonsense"])
    with pytest.raises(SystemExit):
        clone.prepare(identify, "identification")
    assert capsys.readouterr().err.startswith("scripts/identify: error: unrecognized") and len(built) == 1
    monkeypatch.setattr(sys, "argv", ["gap"])
    clone.prepare(gap, "gap")
    assert len(built) == 1


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "frictioncontact", *arguments], capture_output=True, text=True, timeout=600
    )


def test_the_commands_are_listed_and_run(fmu_path: object) -> None:
    done = run()
    assert done.returncode == 0 and all(f"  {name} " in done.stdout for name in entry.COMMANDS)
    done = run("simulte")
    assert done.returncode == 1
    assert done.stderr.startswith("error: 'simulte' is no command; did you mean simulate? these are: table2")
    lines = run("version").stdout.splitlines()
    assert lines[0].startswith("frictioncontact 0.") and lines[1].endswith("FrictionContact.fmu")


def test_wrong_arguments_are_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    for words, message in (
        (["--stop", "1"], "the following arguments are required: --step"),
        (["--stop", "1", "--step", "fast"], "argument --step: invalid float value: 'fast'"),
        (["--stop", "1", "--step", "1", "V=2"], "unrecognized arguments: V=2; write --set V=2"),
    ):
        with pytest.raises(SystemExit, match=r"^2$"):
            simulation.arguments(words)
        name = "frictioncontact simulate"
        assert capsys.readouterr().err == f"{name}: error: {message}; see {name} --help\n"
    # A value, and no option, for which argparse takes the form -1e-4 up to Python 3.13.
    assert simulation.arguments(["--stop", "1", "--step", "-1e-4"]).step == -1e-4
