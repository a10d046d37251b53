"""What the tests of the release share: libraries compiled for any platform, each once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

MISSING = "the release's packages are not installed: scripts/setup release"
pytest.importorskip("lief", reason=MISSING)
pytest.importorskip("ziglang", reason=MISSING)

from tools.release.command import compile_platform  # noqa: E402


@pytest.fixture(scope="session")
def library() -> Callable[[str], Path]:
    """The library of a platform, in CMake's folder for it, compiled when first asked for."""
    return cache(compile_platform)
