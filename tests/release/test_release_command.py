"""scripts/release: a valid file that importers run, or one line that says why not and nothing left behind."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from rich.progress import Progress

from frictioncontact.batch.runner import SIGNATURES
from frictioncontact.errors import UserError
from tools import description, zig
from tools.release import command as release
from tools.release import inspect as release_inspect
from tools.release import targets as release_targets

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


def test_the_wheel_and_the_page_are_the_released_files(released: Path, tmp_path: Path) -> None:
    """The wheel has a batch host with every function that Python calls, too. The checksums are all right."""
    wheel = released.with_name(packages(released.parent)[1])
    with zipfile.ZipFile(wheel) as archive:
        for name in ("FrictionContact.fmu", "playground.html"):
            inside = archive.read(f"frictioncontact/bundled/{name}")
            assert inside == released.with_name(name).read_bytes()
        host = Path(archive.extract("frictioncontact/bundled/friction_batch.so", tmp_path))
    assert SIGNATURES.keys() <= release_inspect.check("linux64", host, "batch_").exports
    with zipfile.ZipFile(released) as archive:
        assert archive.read("documentation/playground.html") == inside
        assert b'<a href="playground.html">' in archive.read("documentation/index.html")
    subprocess.run(["sha256sum", "--check", "--strict", "SHA256SUMS"], cwd=released.parent, check=True)


def test_it_is_one_of_ours(released: Path) -> None:
    command = [sys.executable, "-m", "tools", "tools.release.command", "--check", str(released)]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    assert len(said) == 4 and all(line.startswith("ok  ") for line in said)


def test_contents(released: Path) -> None:
    with zipfile.ZipFile(released) as archive:
        assert b"Lawrence Livermore" in archive.read("documentation/licenses/sundials-license.txt")
        assert b"DE-AC52-07NA27344" in archive.read("documentation/licenses/sundials-notice.txt")
        assert archive.read("model.png").startswith(b"\x89PNG")
        names = {"binaries/linux64/FrictionContact.so", "sources/fmi2/step.c", "sources/fmi2Functions.h"}
        assert names | {"documentation/licenses/license.txt"} <= set(archive.namelist())


def test_cvode_is_inside_and_agrees(released: Path) -> None:
    values = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}
    runs = [
        simulate_fmu(str(released), start_values=values | {"solver.method": method}, output=["F_t"])["F_t"]
        for method in (1, 2)  # collocation, cvode
    ]
    assert np.abs(runs[0]).max() > 40.0
    assert np.abs(runs[0] - runs[1]).max() < 55.0 * 2e-6


def refuse(output: Path) -> str:
    with Progress(**QUIET) as progress, pytest.raises(UserError) as refusal:
        release.make_release(output, ["linux64"], progress)
    text = str(refusal.value)
    assert "\n" not in text
    return text


def test_a_refusal_leaves_nothing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """What is in the way, a read-only file system, broken code, no compiler."""
    assert "it is a folder" in refuse(tmp_path)
    (tmp_path / "file").touch()
    assert "can't be written" in refuse(tmp_path / "file" / "FrictionContact.fmu")
    if Path("/proc/version").exists():
        assert "can't be written" in refuse(Path("/proc/FrictionContact.fmu"))

    def broken(*_: object) -> None:
        raise UserError("In file contact.c:\ncontact.c:1: error: surprise\n1 error\n")

    monkeypatch.setattr(release_targets, "build_targets", broken)
    assert refuse(tmp_path / "FrictionContact.fmu") == "the build fails: contact.c:1: error: surprise"
    monkeypatch.setattr(zig.importlib.util, "find_spec", lambda name: None)
    assert "cross compiler is missing" in refuse(tmp_path / "new" / "FrictionContact.fmu")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_file_that_is_not_valid(monkeypatch: pytest.MonkeyPatch, released: Path) -> None:
    """An older release stays as it was."""
    before = released.read_bytes()
    monkeypatch.setattr(release, "validate_fmu", lambda path: ["a made-up problem\nof two lines"])
    assert refuse(released) == "the validator finds: a made-up problem of two lines"
    assert released.read_bytes() == before
