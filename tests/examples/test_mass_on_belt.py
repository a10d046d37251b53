"""MassOnBelt.fmu by itself: the oscillation is exact, its XML is true, wrong values are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from scipy.linalg import expm

END, STEP = 0.35, 0.05  # s


def run(fmu: Path, outputs: list[str], **values: float) -> np.ndarray:
    how = {"stop_time": END, "output_interval": STEP, "output": outputs}
    return simulate_fmu(str(fmu), start_values=values, fmi_type="CoSimulation", **how)


def test_the_description_is_valid_and_true(mass_on_belt: Path) -> None:
    assert validate_fmu(str(mass_on_belt)) == []
    variables = read_model_description(str(mass_on_belt)).modelVariables
    starts = {variable.name: float(variable.start) for variable in variables if variable.start is not None}
    rows = run(mass_on_belt, list(starts))
    assert len(starts) == 9 and {name: rows[name][0] for name in starts} == starts


def test_steps_are_exact(mass_on_belt: Path) -> None:
    m, k, c, F = 2.0, 3e3, 20.0, 40.0
    belt = {"belt.V_0": 0.1, "belt.V_1": 0.4, "belt.f": 3.0}
    rows = run(mass_on_belt, ["x", "v", "V"], m=m, k=k, c=c, F=F, x_0=0.02, v_0=-0.3, **belt)
    matrix = np.array([[0.0, 1.0, 0.0], [-k / m, -c / m, F / m], [0.0, 0.0, 0.0]])
    x, v, _ = expm(matrix * END) @ (0.02, -0.3, 1.0)
    V = 0.1 + 0.4 * np.sin(2 * np.pi * 3.0 * END) - v
    assert rows[-1].tolist() == pytest.approx([END, V, x, v], rel=1e-9)


def test_wrong_values_are_refused(mass_on_belt: Path) -> None:
    nan = float("nan")
    overdamped = {"m": 1.0, "k": 100.0, "c": 20.0}
    for values in ({"m": 0.0}, {"k": -1.0}, {"c": -1.0}, {"F": nan}, overdamped):
        with pytest.raises(FMICallException):
            run(mass_on_belt, ["x"], **values)
