"""The C unit tests of this folder, built and run: a program for each module of fmu_src."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tools.build import build_targets

PROGRAMS = sorted(path.stem for path in Path(__file__).parent.glob("test_*.c"))
SKIPPED = 77


@pytest.fixture(scope="session")
def folder() -> Path:
    """Of the programs, in the default build."""
    return build_targets("default", ["unit_tests"]) / "tests" / "unit"


@pytest.mark.parametrize("program", PROGRAMS)
def test_unit(program: str, folder: Path) -> None:
    environment = {**os.environ, "LOCPATH": str(folder / "locales")}
    done = subprocess.run([folder / f"unit_{program}"], env=environment, capture_output=True, text=True)
    if done.returncode == SKIPPED:
        pytest.skip(done.stderr)
    assert done.returncode == 0, done.stderr
