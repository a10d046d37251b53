"""The types of the package, as a user's type checker sees them."""

from __future__ import annotations

import runpy
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("user_script.py")
NOT_SEEN = "dask.*,distributed.*,matplotlib.*,PIL.*,rich.*,scipy.*"  # three quarters of the time


def test_the_script_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        runpy.run_path(str(SCRIPT))


@pytest.mark.parametrize(
    "checker",
    [
        "mypy --strict --no-incremental --config-file mypy.ini",
        pytest.param(
            f"pyright --pythonpath {sys.executable}",
            marks=pytest.mark.skipif(shutil.which("pyright") is None, reason="needs pyright and Node.js"),
        ),
    ],
)
def test_in_its_strictest_form(tmp_path: Path, checker: str) -> None:
    (tmp_path / "mypy.ini").write_text(f"[mypy]\n[mypy-{NOT_SEEN}]\nfollow_imports = skip\n")
    name, *words = checker.split()
    command = [sys.executable, "-m", "mypy"] if name == "mypy" else [name]
    done = subprocess.run([*command, *words, SCRIPT], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
