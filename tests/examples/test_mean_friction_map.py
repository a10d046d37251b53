"""The example of simulate_many: its figures are those of the closed limits, and its picture is drawn."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "simulate-many" / "mean_friction_map.py"


def test_map(fmu_path: Path, tmp_path: Path) -> None:
    picture = tmp_path / "map.png"
    done = subprocess.run(
        [sys.executable, SCRIPT, "--quick", "--fmu", fmu_path, "--output", picture],
        capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("3600 scenarios in ")
    low, high = map(float, re.search(r"from (\S+) to (\S+) F_C", done.stdout).groups())
    # delta stays within F_C over the least stiffness, so the force within F_C times this ratio (Eq. 3).
    R_q, d, a_d = 6.0, 14.0, 0.18 * 6.0  # um
    ratio = np.exp(2 * 3.0 * 2 * a_d / R_q) * ((d + a_d) / (d - a_d)) ** 3
    assert -ratio < low < 0.0 < 1.0 < high < ratio
    assert min(Image.open(picture).size) > 500
