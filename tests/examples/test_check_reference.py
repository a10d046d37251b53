"""An FMU held against the results that it carries: missed when changed, errors in one line.

tests/release/test_verify.py has that the FMU meets them.
"""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import check_reference
import pytest
from check_reference import CheckError, check

FOLDER = Path("extra") / "org.fmi-standard.fmi-ls-ref"


def started(fmu: Path) -> subprocess.CompletedProcess[str]:
    """As its user starts it."""
    command = [sys.executable, check_reference.__file__, str(fmu)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


@pytest.fixture
def unpacked(fmu_path: Path, tmp_path: Path) -> Path:
    folder = tmp_path / "unpacked"
    with zipfile.ZipFile(fmu_path) as archive:
        archive.extractall(folder)
    return folder


def test_a_changed_result_is_missed(unpacked: Path) -> None:
    path = unpacked / FOLDER / "default-experiment.csv"
    head, line, *rest = path.read_text().splitlines()
    path.write_text("\n".join([head, line.replace("0.0,0.0", "0.0,1.0", 1), *rest]))
    done = started(unpacked)
    assert done.returncode == 1
    assert [line for line in done.stdout.splitlines() if line.startswith("MISSED")] == [
        "MISSED default-experiment: F_t: 1, bound 5.5e-05"
    ]


def test_what_is_wrong_is_one_line(unpacked: Path) -> None:
    for file, text, message in (
        ("table2-row2-identified.ssv", None, "table2-row2-identified.ssv can't be read: No such file"),
        ("default-experiment.csv", "time,F_t\n0,0\n", "communication points are not those"),
        ("validation.exp", "<a", "validation.exp can't be read: "),
        ("fmi-ls-manifest.xml", "<a/>", "no experiment is listed"),
    ):
        if text is None:
            (unpacked / FOLDER / file).unlink()
        else:
            (unpacked / FOLDER / file).write_text(text)
        with pytest.raises(CheckError) as error:
            check(unpacked)
        assert message in str(error.value) and "\n" not in str(error.value)


def test_no_fmu_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "text.fmu").write_text("text")
    with pytest.raises(CheckError, match="is no FMU"):
        check(tmp_path / "text.fmu")
    done = started(tmp_path / "none.fmu")
    assert done.returncode == 1
    assert re.fullmatch(r"error: .*none\.fmu is no FMU: .*\n", done.stderr), done.stderr
