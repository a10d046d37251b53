"""Makes the examples importable, and their second FMU."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
for folder in ("examples", "examples/stick-slip", "examples/ultrasonic-slider", "examples/ci-validation"):
    sys.path.append(str(ROOT / folder))


@pytest.fixture(scope="session")
def mass_on_belt(fmu_path: Path) -> Path:
    path = fmu_path.parent / "examples" / "MassOnBelt.fmu"
    if not path.is_file():
        pytest.fail(f"{path.relative_to(ROOT)} is missing: build it with scripts/run", pytrace=False)
    return path
