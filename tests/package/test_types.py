"""The types of the package, as a user's type checker sees them."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("user_script.py")


def test_the_script_runs(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-W", "error", SCRIPT], cwd=tmp_path, check=True, capture_output=True)


def test_mypy_in_its_strictest_form(tmp_path: Path) -> None:
    words = ["--strict", "--no-incremental", "--cache-dir", tmp_path, SCRIPT]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *words], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.skipif(shutil.which("pyright") is None, reason="needs pyright, which needs Node.js")
def test_pyright(tmp_path: Path) -> None:
    words = ["--pythonpath", sys.executable, SCRIPT]
    done = subprocess.run(["pyright", *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
