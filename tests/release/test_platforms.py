"""The libraries of other platforms give the numbers that linux64's gives.

Windows' runs under Wine, that of ARM under qemu's user mode, if they are there.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scenario_runs import OUTPUTS, build_host, largest_difference, run

from frictioncontact.fmu import FrictionFmu, simulate
from frictioncontact.parameters import IDENTIFIED, PERIOD, TABLE_2, start_values

WINE = next(filter(None, map(shutil.which, ("wine64", "wine", "/usr/lib/wine/wine64"))), None)
QEMU = next(filter(None, map(shutil.which, ("qemu-aarch64", "qemu-aarch64-static"))), None)
ARM_LIBRARIES = Path("/usr/aarch64-linux-gnu")
LIMIT = 1e-12  # of the largest value of each output in the scenario


@pytest.fixture(scope="module")
def linux_runs(library: Callable[[str], Path], fmu: FrictionFmu) -> dict[str, np.ndarray]:
    path = library("linux64")
    return run([str(build_host("linux64", path))], path, fmu.description)


def test_linux_agrees_with_the_default_build(linux_runs: dict[str, np.ndarray], fmu: FrictionFmu) -> None:
    """Another compiler and another importer, the same scenario."""
    table = linux_runs["table2-row2-identified"][:100, 1:]
    steps = simulate(fmu, start_values(TABLE_2[1], IDENTIFIED), PERIOD / 100, 100, outputs=OUTPUTS)
    for k, name in enumerate(OUTPUTS):
        assert np.abs(table[:, k] - steps[name][1:]).max() <= LIMIT * np.abs(steps[name]).max(), name


@pytest.mark.skipif(
    not QEMU or not ARM_LIBRARIES.is_dir(), reason="qemu-user or libc6-arm64-cross is missing"
)
def test_linux_on_arm(
    library: Callable[[str], Path], linux_runs: dict[str, np.ndarray], fmu: FrictionFmu
) -> None:
    path = library("aarch64-linux")
    start = [str(QEMU), "-L", str(ARM_LIBRARIES), str(build_host("aarch64-linux", path))]
    differences = largest_difference(linux_runs, run(start, path, fmu.description))
    assert max(differences.values()) <= LIMIT, differences


@pytest.mark.skipif(not WINE, reason="Wine is missing (Debian: wine64)")
@pytest.mark.slow
def test_windows(
    library: Callable[[str], Path],
    linux_runs: dict[str, np.ndarray],
    fmu: FrictionFmu,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(os.environ, "WINEPREFIX", str(tmp_path / "wine"))
    monkeypatch.setitem(os.environ, "WINEDEBUG", "-all")
    path = library("win64")
    start = [str(WINE), str(build_host("win64", path))]
    differences = largest_difference(linux_runs, run(start, path, fmu.description))
    assert max(differences.values()) <= LIMIT, differences
