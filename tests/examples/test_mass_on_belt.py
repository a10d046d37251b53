"""MassOnBelt.fmu by itself: the oscillation is exact, its XML is true, wrong values are refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu
from scipy.linalg import expm


class Mass:
    def __init__(self, folder: str) -> None:
        description = read_model_description(folder)
        self.variables = {variable.name: variable for variable in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=folder,
            instanceName="mass",
        )
        self.slave.instantiate()
        self.slave.setupExperiment()

    def start(self, **values: float) -> None:
        for name, value in values.items():
            self.set(name, value)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set(self, name: str, value: float) -> None:
        self.slave.setReal([self.variables[name].valueReference], [value])

    def get(self, name: str) -> float:
        return self.slave.getReal([self.variables[name].valueReference])[0]


@pytest.fixture
def mass(mass_on_belt: Path, tmp_path: Path) -> Iterator[Mass]:
    one = Mass(extract(str(mass_on_belt), str(tmp_path)))
    yield one
    one.slave.freeInstance()


def test_validates(mass_on_belt: Path) -> None:
    assert validate_fmu(str(mass_on_belt)) == []


def test_start_values_are_those_of_the_xml(mass: Mass) -> None:
    started = {name: float(v.start) for name, v in mass.variables.items() if v.start is not None}
    assert len(started) == 9
    assert {name: mass.get(name) for name in started} == started


def test_steps_are_exact(mass: Mass) -> None:
    m, k, c, F, end, steps = 2.0, 3e3, 20.0, 40.0, 0.35, 7
    mass.start(m=m, k=k, c=c, x_0=0.02, v_0=-0.3, F=F, **{"belt.V_0": 0.1, "belt.V_1": 0.4, "belt.f": 3.0})
    assert mass.get("V") == pytest.approx(0.1 + 0.3, rel=1e-15)
    for n in range(steps):
        mass.slave.doStep(n * end / steps, end / steps)
    matrix = np.array([[0.0, 1.0, 0.0], [-k / m, -c / m, F / m], [0.0, 0.0, 0.0]])
    x, v, _ = expm(matrix * end) @ (0.02, -0.3, 1.0)
    belt = 0.1 + 0.4 * np.sin(2 * np.pi * 3.0 * end)
    assert [mass.get(name) for name in ("x", "v", "V")] == pytest.approx([x, v, belt - v], rel=1e-9)


def test_wrong_values_are_refused(mass: Mass) -> None:
    for name, value in (("m", 0.0), ("k", -1.0), ("c", -1.0), ("F", float("nan")), ("x", 1.0), ("V", 1.0)):
        before = mass.get(name)
        with pytest.raises(FMICallException):
            mass.set(name, value)
        assert mass.get(name) == before
    with pytest.raises(FMICallException):  # overdamped
        mass.start(m=1.0, k=100.0, c=20.0)


def test_parameters_are_fixed_once_it_runs(mass: Mass) -> None:
    mass.start()
    with pytest.raises(FMICallException):
        mass.set("m", 1.0)
    mass.set("F", 1.0)
