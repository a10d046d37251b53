"""The FMU compiles from its own sources, without SUNDIALS; `cvode` is then refused clearly."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from fmpy import supported_platforms

from frictioncontact.fmu import FrictionError, FrictionFmu, simulate


@pytest.fixture
def without_binaries(fmu_path: Path, tmp_path: Path) -> Path:
    """The FMU as it would be without any library."""
    bare = tmp_path / "FrictionContact.fmu"
    with zipfile.ZipFile(fmu_path) as whole, zipfile.ZipFile(bare, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in whole.namelist():
            if not name.startswith("binaries/"):
                archive.writestr(name, whole.read(name))
    assert supported_platforms(bare) == ["c-code"]
    return bare


def check_runs_without_cvode(path: Path, whole: FrictionFmu) -> None:
    start = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}
    with FrictionFmu(path) as compiled:
        run, expected = (simulate(fmu, start, 5e-7, 200, outputs=["F_t"])["F_t"] for fmu in (compiled, whole))
        assert abs(run - expected).max() <= 1e-12 * 55.0
        with pytest.raises(FrictionError, match=r"cvode.*SUNDIALS"):
            compiled.session({"solver.method": "cvode"})


def test_fmpy_compile(without_binaries: Path, fmu: FrictionFmu) -> None:
    command = [sys.executable, "-m", "fmpy", "compile", str(without_binaries), "--configuration", "Debug"]
    folder = Path(sys.executable).parent  # fmpy calls cmake from the path
    done = subprocess.run(
        command, env={"PATH": f"{folder}:/usr/bin:/bin"}, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    check_runs_without_cvode(without_binaries, fmu)


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no cc")
@pytest.mark.skipif(sys.platform != "linux", reason="the command is Linux's")
def test_any_c11_compiler(without_binaries: Path, fmu: FrictionFmu, tmp_path: Path) -> None:
    """One plain command, strict and without a warning."""
    with zipfile.ZipFile(without_binaries) as archive:
        archive.extractall(tmp_path / "fmu")
    sources = sorted(str(path) for path in (tmp_path / "fmu" / "sources").rglob("*.c"))
    target = tmp_path / "fmu" / "binaries" / "linux64" / "FrictionContact.so"
    target.parent.mkdir(parents=True)
    flags = ["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O0", "-fPIC", "-shared", "-Isources"]
    done = subprocess.run(
        ["cc", *flags, *sources, "-o", str(target), "-lm"],
        cwd=tmp_path / "fmu",
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    with zipfile.ZipFile(without_binaries, "a") as archive:
        archive.write(target, "binaries/linux64/FrictionContact.so")
    check_runs_without_cvode(without_binaries, fmu)
