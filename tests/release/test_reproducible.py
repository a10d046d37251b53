"""The same sources give the same bytes, wherever they lie and whatever the compiler has cached."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from frictionlab.release.command import compile_platforms
from frictionlab.release.sundials import SundialsSource

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
@pytest.mark.parametrize("platform", ["linux64", "aarch64-darwin"])
def test_another_folder_and_an_empty_cache(
    library: Callable[[str], Path], sundials: SundialsSource, tmp_path: Path, platform: str
) -> None:
    elsewhere = tmp_path / "another name" / "checkout"
    for name in ("fmu_src", "cmake"):
        shutil.copytree(ROOT / name, elsewhere / name)
    shutil.copy(ROOT / "modelDescription.xml", elsewhere)
    moved = SundialsSource(elsewhere / "sundials", sundials.version, sundials.sha256)
    shutil.copytree(sundials.folder, moved.folder)
    work = tmp_path / "work"
    work.mkdir()
    again = compile_platforms([platform], work, moved, cache=tmp_path / "cache", root=elsewhere)
    assert again[platform].read_bytes() == library(platform).read_bytes()
