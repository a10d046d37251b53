"""The calibration by CasADi's gradient: it finds the truth in both interfaces."""

from __future__ import annotations

import sys

import casadi as ca
import numpy as np
import pytest

import frictioncontact as fc
from frictioncontact.fmu import FrictionFmu, Session
from tools.project import ROOT
from tools.reference import scene_of, settled

sys.path.append(str(ROOT / "examples" / "calibration"))
from calibrate import GUESS, SCENE, STEP, STOP, TRUTH, calibrate, forces

SPEEDS = (0.2, 0.5, 0.8, 1.1)  # m/s


class MeanForces(ca.Callback):
    """F_t_settled [N] at the speeds, or its derivatives, over the parameters over their guesses."""

    def __init__(self, name: str, session: Session, columns: int = 1) -> None:
        ca.Callback.__init__(self)
        self.session, self.columns = session, columns
        self.construct(name, {})

    def get_n_in(self) -> int:
        return min(self.columns, 2)  # derivatives also take the values

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(len(GUESS) if i == 0 else len(SPEEDS), 1)

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(len(SPEEDS), self.columns)

    def has_jacobian(self) -> bool:
        return self.columns == 1

    def get_jacobian(self, name: str, *_: object) -> ca.Function:
        self.derivatives = MeanForces(name, self.session, len(GUESS))
        return self.derivatives

    def eval(self, arguments: list[ca.DM]) -> list[ca.DM]:
        for k, (name, guess) in enumerate(GUESS.items()):
            self.session.set(name, guess * float(arguments[0][k]))
        rows = []
        for V in SPEEDS:
            self.session.set("V", V)
            slopes = [guess * self.session.slope("F_t_settled", name) for name, guess in GUESS.items()]
            rows.append(slopes if self.columns > 1 else [self.session.get("F_t_settled")])
        return [ca.DM(rows)]


def test_model_exchange_finds_the_truth() -> None:
    run = fc.simulate(SCENE | TRUTH, stop=STOP, step=STEP, outputs=["F_t"])
    found = calibrate(forces, run["F_t"].to_numpy()[1:])
    assert found == {name: pytest.approx(value, rel=1e-6) for name, value in TRUTH.items()}


def test_co_simulation_finds_the_truth(fmu: FrictionFmu) -> None:
    """The measurement is the independent reference's."""
    measured = [settled(scene_of(SCENE | TRUTH | {"V": V}))[0] for V in SPEEDS]
    with fmu.session(SCENE | {"solver.tolerance": 1e-10}) as session:
        found = calibrate(MeanForces("mean_forces", session), np.array(measured))
    assert found == {name: pytest.approx(value, rel=1e-7) for name, value in TRUTH.items()}
