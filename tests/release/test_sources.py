"""The FMU compiles from its own sources, without SUNDIALS; `cvode` is then refused clearly."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from fmpy.model_description import read_build_description
from lxml import etree

from frictioncontact.fmu import FrictionError, FrictionFmu, simulate


@pytest.fixture
def broken_sundials(tmp_path: Path) -> Path:
    """A folder of headers that no compiler accepts."""
    header = tmp_path / "sundials" / "cvode" / "cvode.h"
    header.parent.mkdir(parents=True)
    header.write_text("#error SUNDIALS is used\n")
    return header.parents[1]


def test_the_build_description_lists_the_sources(fmu_path: Path) -> None:
    """FMPy reads it against its schema; the interfaces of the model description list the same files."""
    (build,) = read_build_description(fmu_path)
    (files,) = build.sourceFileSets
    assert build.modelIdentifier == "FrictionContact"
    assert [definition.name for definition in files.preprocessorDefinitions] == ["FC_NO_CVODE"]
    with zipfile.ZipFile(fmu_path) as archive:
        packed = [name.removeprefix("sources/") for name in archive.namelist() if name.endswith(".c")]
        xml = etree.fromstring(archive.read("modelDescription.xml"))
    assert sorted(files.sourceFiles) == sorted(packed)
    for interface in ("ModelExchange", "CoSimulation"):
        assert [file.get("name") for file in xml.find(f"{interface}/SourceFiles")] == files.sourceFiles


def test_fmpy_compile(without_binaries: Path, broken_sundials: Path, fmu: FrictionFmu) -> None:
    """By the list of sources: FMPy 0.3.32 reads no build description of FMI 2.0. SUNDIALS is ignored."""
    command = [sys.executable, "-m", "fmpy", "compile", str(without_binaries), "--configuration", "Debug"]
    folder = Path(sys.executable).parent  # fmpy calls cmake from the path
    environment = {"PATH": f"{folder}:/usr/bin:/bin", "CPATH": str(broken_sundials)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    start = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}
    expected = simulate(fmu, start, 5e-7, 200, outputs=["F_t"])["F_t"]
    with FrictionFmu(without_binaries) as compiled:
        run = simulate(compiled, start, 5e-7, 200, outputs=["F_t"])["F_t"]
        assert abs(run - expected).max() <= 1e-12 * 55.0
        with pytest.raises(FrictionError, match=r"cvode.*SUNDIALS"):
            compiled.session({"solver.method": "cvode"})


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no cc")
def test_any_c11_compiler(without_binaries: Path, broken_sundials: Path, tmp_path: Path) -> None:
    """Strict and without a warning. FC_NO_CVODE holds where SUNDIALS is, too."""
    with zipfile.ZipFile(without_binaries) as archive:
        archive.extractall(tmp_path)
    sources = sorted((tmp_path / "sources").rglob("*.c"))
    options = "-DFC_NO_CVODE -DFC_WITH_SUNDIALS -std=c11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only"
    command = ["cc", *options.split(), "-Isources", f"-I{broken_sundials}", *sources]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
