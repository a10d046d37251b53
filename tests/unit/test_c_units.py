"""The C unit tests of this folder, built here and run by CTest: one program a module of fmu_src."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from workshop.build import build_targets

PROGRAMS = sorted(path.stem for path in Path(__file__).parent.glob("test_*.c"))
TOOLS = Path(sys.executable).parent


def run(tool: str, *arguments: str) -> str:
    done = subprocess.run([str(TOOLS / tool), *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def build_folder() -> str:
    """The folder of the default build, with the unit tests' programs."""
    return str(build_targets("default", ["unit_tests"]))


@pytest.mark.parametrize("program", PROGRAMS)
def test_unit(program: str, build_folder: str) -> None:
    chosen = ["--tests-regex", f"^unit.{program}$", "--no-tests=error", "--output-on-failure"]
    output = run("ctest", "--test-dir", build_folder, *chosen)
    if "***Skipped" in output:
        pytest.skip(output)
