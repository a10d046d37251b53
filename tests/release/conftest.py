"""What the tests of the release share: libraries compiled for any platform, each once."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

MISSING = "the release's packages are not installed: scripts/setup release"
pytest.importorskip("lief", reason=MISSING)
pytest.importorskip("ziglang", reason=MISSING)

from workshop.release.command import compile_platforms  # noqa: E402


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The library of a platform, in CMake's folder for it, compiled when first asked for."""
    compiled: dict[str, Path] = {}

    def compile_once(platform: str) -> Path:
        if platform not in compiled:
            compiled.update(compile_platforms([platform], tmp_path_factory.mktemp("release")))
        return compiled[platform]

    return compile_once


@pytest.fixture(scope="session")
def copy_compiled(library: Callable[[str], Path]) -> Callable[..., dict[str, Path]]:
    """In place of compile_platforms: copies what it made when it was first asked for a platform."""

    def copy(platforms: Iterable[str], folder: Path, **_: object) -> dict[str, Path]:
        libraries = {}
        for platform in platforms:
            compiled = library(platform)
            shutil.copytree(compiled.parent, folder / platform)
            libraries[platform] = folder / platform / compiled.name
        return libraries

    return copy
