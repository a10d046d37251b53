"""The second FMU of the examples."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def mass_on_belt(fmu_path: Path) -> Path:
    path = fmu_path.parent / "examples" / "MassOnBelt.fmu"
    if not path.is_file():
        pytest.fail(f"{path.relative_to(ROOT)} is missing: build it with scripts/run", pytrace=False)
    return path
