"""What all tests share: the built FMU, or the one that FRICTION_FMU names."""

from __future__ import annotations

import os
import shutil
import signal
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from fmpy.fmi1 import printLogMessage
from fmpy.fmi2 import defaultCallbacks, fmi2CallbackLoggerTYPE

from frictioncontact.fmu import FrictionFmu

if TYPE_CHECKING:
    from playwright.sync_api import Browser

# Started in the background, a runner ignores Control-C, and so would the commands that tests interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)
# fmpy's own callbacks call the logger of the last simulate_fmu of the process, which is freed: a crash.
defaultCallbacks.logger = fmi2CallbackLoggerTYPE(printLogMessage)

ROOT = Path(__file__).resolve().parent.parent
LONGEST = """
    test_scenes test_wheel test_site test_reproducible test_report test_building test_machine test_belt_page
    test_identify test_command_lines test_fuzz test_types test_sweep_cluster test_sweep test_rigs test_c_units
    test_importers test_validate test_tolerance test_release_command test_sources test_simulate_many
""".split()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest files first, each before shorter ones, so that no core waits for another at the end."""
    items.sort(key=lambda item: LONGEST.index(item.path.stem) if item.path.stem in LONGEST else len(LONGEST))


@pytest.fixture(scope="session")
def copy_project() -> Callable[[Path], Path]:
    """Copies the project as a clean checkout has it: without .venv and build."""

    def copy(target: Path) -> Path:
        left_out = shutil.ignore_patterns(
            "build", ".git", ".hypothesis", ".venv*", ".*cache*", "__pycache__", "*.png"
        )
        shutil.copytree(ROOT, target, ignore=left_out)
        shutil.copy(ROOT / "docs/fmu/model.png", target / "docs/fmu")
        return target

    return copy


@pytest.fixture(scope="session")
def fmu_path() -> Path:
    path = Path(os.environ.get("FRICTION_FMU", ROOT / "build" / "FrictionContact.fmu"))
    if not path.is_file():
        pytest.fail(f"{path} is missing: build it with scripts/run", pytrace=False)
    return path


@pytest.fixture(scope="session")
def mass_on_belt(fmu_path: Path) -> Path:
    """The second FMU of the examples."""
    return fmu_path.parent / "examples" / "MassOnBelt.fmu"


Entries = dict[str, bytes]


@pytest.fixture
def repacked(fmu_path: Path, tmp_path: Path) -> Callable[[Callable[[Entries], object]], Path]:
    """Gives a copy of the FMU, whose entries a function changes."""

    def pack(change: Callable[[Entries], object]) -> Path:
        with zipfile.ZipFile(fmu_path) as archive:
            entries = {name: archive.read(name) for name in archive.namelist()}
        change(entries)
        with zipfile.ZipFile(tmp_path / "FrictionContact.fmu", "w") as archive:
            for name, content in entries.items():
                archive.writestr(name, content)
        return tmp_path / "FrictionContact.fmu"

    return pack


@pytest.fixture
def without_binaries(repacked: Callable[[Callable[[Entries], object]], Path]) -> Path:
    """The FMU with its sources alone."""

    def bare(entries: Entries) -> None:
        for name in [name for name in entries if name.startswith("binaries/")]:
            del entries[name]

    return repacked(bare)


@pytest.fixture(scope="session")
def fmu(fmu_path: Path) -> Iterator[FrictionFmu]:
    """The FMU, loaded once for all tests."""
    with FrictionFmu(fmu_path) as loaded:
        yield loaded


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """A headless Chromium: a process can have one at a time."""
    from tools.browser import chromium, find_browser

    if find_browser() is None:
        pytest.skip("no Chromium is installed")
    with chromium() as browser:
        yield browser


@pytest.fixture(scope="session")
def unzipped_fmu(fmu: FrictionFmu) -> Path:
    """The directory with the FMU's files."""
    return fmu.directory
