"""The programs of bench/, built beside the FMU."""

from __future__ import annotations

from pathlib import Path

import pytest

from frictionlab.bench.driver import Bench, build_programs
from frictionlab.fmu import FrictionFmu


@pytest.fixture(scope="session")
def bench(fmu: FrictionFmu, fmu_path: Path) -> Bench:
    build_programs(fmu_path.parent)
    return Bench(fmu, fmu_path.parent / "bench")
