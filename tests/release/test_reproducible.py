"""The same sources give the same bytes, wherever they lie and whatever the compiler has cached."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from workshop.release.command import compile_platforms


@pytest.mark.slow
@pytest.mark.parametrize("platform", ["linux64", "aarch64-darwin"])
def test_another_folder_and_an_empty_cache(
    library: Callable[[str], Path], copy_project: Callable[[Path], Path], tmp_path: Path, platform: str
) -> None:
    elsewhere = copy_project(tmp_path / "another name" / "checkout")
    again = compile_platforms([platform], tmp_path / "work", tmp_path / "cache", elsewhere)
    assert again[platform].read_bytes() == library(platform).read_bytes()
