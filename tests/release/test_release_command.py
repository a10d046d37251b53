"""scripts/release: a valid file that importers run, or one line that says why not and nothing left behind."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from rich.progress import Progress

from frictioncontact.batch.runner import SIGNATURES
from frictioncontact.errors import UserError
from workshop import description
from workshop.release import command as release
from workshop.release import inspect as release_inspect
from workshop.release import targets as release_targets

QUIET = {"transient": True, "disable": True}


@pytest.fixture(scope="module")
def released(tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("released") / "FrictionContact.fmu"
    with Progress(**QUIET) as progress:
        release.make_release(output, ["linux64"], progress)
    return output


def test_file_is_valid_and_alone(released: Path) -> None:
    assert validate_fmu(str(released)) == []
    beside = {"FrictionContact.fmu", "SHA256SUMS", "playground.html", *packages(released.parent)}
    assert {path.name for path in released.parent.iterdir()} == beside


def packages(folder: Path) -> list[str]:
    """Names of the sdist and of the wheel for x86-64 Linux."""
    version = description.read().version
    names = [
        f"frictioncontact-{version}.tar.gz",
        f"frictioncontact-{version}-py3-none-manylinux2014_x86_64.whl",
    ]
    assert all((folder / name).is_file() for name in names)
    return names


def test_the_wheel_holds_the_released_files(released: Path, tmp_path: Path) -> None:
    """And a batch host with every function that Python calls."""
    wheel = released.with_name(packages(released.parent)[1])
    with zipfile.ZipFile(wheel) as archive:
        for name in ("FrictionContact.fmu", "playground.html"):
            inside = archive.read(f"frictioncontact/bundled/{name}")
            assert inside == released.with_name(name).read_bytes()
        host = Path(archive.extract("frictioncontact/bundled/friction_batch.so", tmp_path))
    assert SIGNATURES.keys() <= release_inspect.check("linux64", host, "batch_").exports


def test_the_page_of_the_live_fmu_is_inside_and_beside(released: Path) -> None:
    with zipfile.ZipFile(released) as archive:
        page = archive.read("documentation/playground.html")
        assert b'<a href="playground.html">' in archive.read("documentation/index.html")
    assert page == released.with_name("playground.html").read_bytes()
    assert b"default-src 'none'" in page


def test_the_checksums_beside_it_are_those_of_sha256sum(released: Path) -> None:
    subprocess.run(["sha256sum", "--check", "--strict", "SHA256SUMS"], cwd=released.parent, check=True)


def test_it_is_one_of_ours(released: Path) -> None:
    command = [sys.executable, "-m", "workshop", "workshop.release.command", "--check", str(released)]
    run = subprocess.run(command, check=True, capture_output=True, text=True)
    assert len(run.stdout.splitlines()) == 4
    assert all(line.startswith("ok  ") for line in run.stdout.splitlines())
    other = released.with_name("SHA256SUMS")
    run = subprocess.run([*command[:-1], str(other)], capture_output=True, text=True)
    assert run.returncode == 1
    assert run.stderr == f"error: {other} is no FMU: not a zip archive\n"


def test_contents(released: Path) -> None:
    with zipfile.ZipFile(released) as archive:
        names = set(archive.namelist())
        assert b"Redistribution and use" in archive.read("documentation/licenses/license.txt")
        assert b"Lawrence Livermore" in archive.read("documentation/licenses/sundials-license.txt")
        assert b"DE-AC52-07NA27344" in archive.read("documentation/licenses/sundials-notice.txt")
        assert archive.read("model.png").startswith(b"\x89PNG")
    assert {
        "modelDescription.xml",
        "binaries/linux64/FrictionContact.so",
        "documentation/index.html",
    } <= names
    assert {"sources/friction_contact.c", "sources/fmi2/step.c", "sources/fmi2Functions.h"} <= names


def test_cvode_is_inside_and_agrees(released: Path) -> None:
    runs = [
        simulate_fmu(
            str(released),
            start_values={
                "V": 0.5,
                "vibration.V_1": 1.44,
                "contact.stiffnessScale": 4.4e-7,
                "solver.method": method,
            },
            output=["F_t"],
        )["F_t"]
        for method in (1, 2)  # collocation, cvode
    ]
    assert np.abs(runs[0]).max() > 40.0
    assert np.abs(runs[0] - runs[1]).max() < 55.0 * 2e-6


def test_libcosim_runs_it(released: Path) -> None:
    execution_module = pytest.importorskip("libcosimpy.CosimExecution", reason="libcosimpy is not installed")
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = execution_module.CosimExecution.from_step_size(step_size=500)
    index = execution.add_local_slave(local_slave=CosimLocalSlave(fmu_path=str(released), instance_name="c"))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    for _ in range(100):
        assert execution.step()
    assert observer.last_real_values(slave_index=index, variable_references=[3])[0] == pytest.approx(55.0)


def refuse(output: Path) -> str:
    with Progress(**QUIET) as progress, pytest.raises(UserError) as refusal:
        release.make_release(output, ["linux64"], progress)
    text = str(refusal.value)
    assert "\n" not in text
    return text


def test_missing_toolchain(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(release_targets.importlib.util, "find_spec", lambda name: None)
    output = tmp_path / "new" / "FrictionContact.fmu"
    assert "cross compiler is missing" in refuse(output)
    assert not output.parent.exists()


def test_output_that_is_a_folder(tmp_path: Path) -> None:
    assert "it is a folder" in refuse(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_output_below_a_file(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert "can't be written" in refuse(tmp_path / "file" / "FrictionContact.fmu")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere")
def test_output_in_a_read_only_folder(tmp_path: Path) -> None:
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o500)
    assert "Permission denied" in refuse(folder / "FrictionContact.fmu")


@pytest.mark.skipif(not Path("/proc/version").exists(), reason="there is no read-only file system at hand")
def test_output_on_a_read_only_file_system() -> None:
    assert "can't be written" in refuse(Path("/proc/FrictionContact.fmu"))


def test_code_that_does_not_compile(copy_project: Callable[[Path], Path], tmp_path: Path) -> None:
    """The compiler's first error in one line."""
    broken = copy_project(tmp_path / "broken")
    (broken / "fmu_src" / "model" / "contact.c").write_text("int contact(void) { return surprise; }\n")
    command = [sys.executable, "-m", "workshop", "workshop.release.command", "--platforms", "linux64"]
    settings = {"CMAKE_ARGS": "-DWITH_SUNDIALS=OFF"}  # which would only take time
    done = subprocess.run(
        command, cwd=broken, env=release_targets.environment() | settings, capture_output=True, text=True
    )
    assert done.returncode == 1
    assert re.fullmatch(r"error: the build fails: .*contact\.c:1:.*surprise.*\n", done.stderr), done.stderr


def test_a_file_that_is_not_valid(monkeypatch: pytest.MonkeyPatch, released: Path) -> None:
    """An older release stays as it was."""
    before = released.read_bytes()
    monkeypatch.setattr(release, "validate_fmu", lambda path: ["a made-up problem\nof two lines"])
    assert refuse(released) == "the validator finds: a made-up problem of two lines"
    assert released.read_bytes() == before
    beside = {"FrictionContact.fmu", "SHA256SUMS", "playground.html", *packages(released.parent)}
    assert {path.name for path in released.parent.iterdir()} == beside
