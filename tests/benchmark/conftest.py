"""The programs of bench/, built beside the FMU."""

from __future__ import annotations

import pytest

from frictionlab.bench.driver import Bench
from frictionlab.build import build_targets
from frictionlab.fmu import FrictionFmu


@pytest.fixture(scope="session")
def bench(fmu: FrictionFmu) -> Bench:
    return Bench(fmu, build_targets("default", ["bench"]) / "bench")
