"""The programs of bench/, built beside the FMU."""

from __future__ import annotations

import pytest

from frictioncontact.fmu import FrictionFmu
from tools.bench.driver import Bench
from tools.build import build_targets


@pytest.fixture(scope="session")
def bench(fmu: FrictionFmu) -> Bench:
    return Bench(fmu, build_targets("default", ["bench"]) / "bench")
