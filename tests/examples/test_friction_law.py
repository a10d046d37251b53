"""The slider that its friction law drives follows the system in which every period is resolved."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from workshop.project import ROOT

slow_plant = pytest.importorskip("ultrasonic_slider", reason="libcosimpy is not installed")
sys.path.append(str(ROOT / "examples" / "friction-law"))
import slider  # noqa: E402


def test_a_few_calls_meet_the_resolved_system() -> None:
    _, x, calls = slider.slide(0.02, 21)
    _, resolved = slow_plant.reference(0.02, 21)
    assert calls < 150
    assert np.abs(x - resolved[0]).max() * slider.K / 55.0 < 3e-4
