"""The calibration by CasADi's gradient, with the FMU in model exchange: it finds the truth."""

from __future__ import annotations

import sys

import pytest

import frictioncontact as fc
from workshop.project import ROOT

sys.path.append(str(ROOT / "examples" / "calibration"))
from calibrate import SCENE, STEP, STOP, TRUTH, calibrate, forces


def test_model_exchange_finds_the_truth() -> None:
    run = fc.simulate(SCENE | TRUTH, stop=STOP, step=STEP, outputs=["F_t"])
    found = calibrate(forces, run["F_t"].to_numpy()[1:])
    assert found == {name: pytest.approx(value, rel=1e-6) for name, value in TRUTH.items()}
