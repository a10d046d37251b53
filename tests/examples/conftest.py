"""The second FMU of the examples."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def mass_on_belt(fmu_path: Path) -> Path:
    return fmu_path.parent / "examples" / "MassOnBelt.fmu"
