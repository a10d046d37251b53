"""What the tests of the release share: libraries compiled for any platform, each once."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

MISSING = "the release's packages are not installed: scripts/setup release"
pytest.importorskip("lief", reason=MISSING)
pytest.importorskip("ziglang", reason=MISSING)

from frictionlab.release.command import SUNDIALS, compile_platforms  # noqa: E402
from frictionlab.release.sundials import SundialsSource, fetched  # noqa: E402
from frictionlab.release.targets import ReleaseError  # noqa: E402


@pytest.fixture(scope="session")
def sundials() -> SundialsSource:
    try:
        return fetched(SUNDIALS)
    except ReleaseError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory, sundials: SundialsSource) -> Callable[[str], Path]:
    """The library of a platform, compiled when first asked for."""
    compiled: dict[str, Path] = {}

    def compile_once(platform: str) -> Path:
        if platform not in compiled:
            compiled.update(compile_platforms([platform], tmp_path_factory.mktemp("release"), sundials))
        return compiled[platform]

    return compile_once
