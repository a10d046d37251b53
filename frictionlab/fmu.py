"""FrictionContact.fmu through fmpy: load it once, open sessions, step them, read arrays.

    with FrictionFmu("build/FrictionContact.fmu") as fmu, fmu.session({"vibration.V_1": 1.44}) as session:
        session.step(5e-5)
        session.get("F_t_mean")

A value of an enumeration is its number or its item's name. Every refused call raises FrictionError with
the FMU's own message.
"""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from ctypes import c_double, c_int, c_uint
from pathlib import Path
from types import TracebackType

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    calloc,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    free,
)

from .project import UserError

Value = float | int | str
MODEL = "FrictionContact"
INPUTS = ("V", "d", "E")
OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")


class FrictionError(UserError):
    """The FMU refused a call; the text is its message."""


class FrictionFmu:
    """The unzipped FMU and its model description."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._temporary = Path(tempfile.mkdtemp(prefix="friction-fmu-"))
        try:
            self.directory = Path(extract(str(path), unzipdir=str(self._temporary)))
        except zipfile.BadZipFile:
            self.close()
            raise UserError(f"{path} is not an FMU: not a zip archive") from None
        self.description = read_model_description(str(self.directory), validate=False)
        if self.description.modelName != MODEL:
            self.close()
            raise UserError(f"{path} is another FMU: {self.description.modelName}")
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self._library = self._slave()  # keeps the shared library loaded between sessions

    def _slave(self) -> FMU2Slave:
        return FMU2Slave(
            guid=self.description.guid,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            unzipDirectory=str(self.directory),
            instanceName="contact",
        )

    def session(
        self,
        start_values: Mapping[str, Value] | None = None,
        start: float = 0.0,
        tolerance: float | None = None,
    ) -> Session:
        """An initialized instance; times in s."""
        return Session(self, self._slave(), start_values or {}, start, tolerance)

    def close(self) -> None:
        shutil.rmtree(self._temporary, ignore_errors=True)

    def __enter__(self) -> FrictionFmu:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Session:
    """One instance in step mode."""

    def __init__(
        self,
        fmu: FrictionFmu,
        slave: FMU2Slave,
        start_values: Mapping[str, Value],
        start: float,
        tolerance: float | None,
    ) -> None:
        self.fmu = fmu
        self.slave = slave
        self.time = start
        self.messages: list[str] = []
        self._callbacks = fmi2CallbackFunctions()
        self._callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self._callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        self._callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        slave.instantiate(callbacks=self._callbacks, loggingOn=True)
        try:
            self._call(slave.setupExperiment, tolerance, start)
            for name, value in start_values.items():
                self.set(name, value)
            self._call(slave.enterInitializationMode)
            self._call(slave.exitInitializationMode)
        except FrictionError:
            self.close()
            raise

    def _log(
        self, environment: object, instance: bytes, status: int, category: bytes, message: bytes
    ) -> None:
        self.messages.append(message.decode())

    def _call(self, function: object, *arguments: object) -> object:
        before = len(self.messages)
        try:
            return function(*arguments)  # type: ignore[operator]
        except FMICallException as error:
            raise FrictionError("; ".join(self.messages[before:]) or str(error)) from None

    def set(self, name: str, value: Value) -> None:
        variable = self.fmu.variables[name]
        if variable.type == "Real":
            self._call(self.slave.setReal, [variable.valueReference], [float(value)])
            return
        if isinstance(value, str):
            value = {item.name: int(item.value) for item in variable.declaredType.items}[value]
        self._call(self.slave.setInteger, [variable.valueReference], [int(value)])

    def set_rates(self, **rates: float) -> None:
        """Time derivatives of V, d, E over the next step."""
        references = [self.fmu.variables[name].valueReference for name in rates]
        self._call(self.slave.setRealInputDerivatives, references, [1] * len(rates), list(rates.values()))

    def step(self, h: float) -> None:
        """Advance by h [s]."""
        self._call(self.slave.doStep, self.time, h)
        self.time += h

    def step_many(self, h: float, count: int) -> None:
        """count steps of h [s] with held inputs, with as little Python as possible between them."""
        do_step, component, time = self.slave.fmi2DoStep, self.slave.component, self.time
        for k in range(count):
            self._call(do_step, component, time + k * h, h, 1)
        self.time = time + count * h

    def get(self, name: str) -> float:
        return self.slave.getReal([self.fmu.variables[name].valueReference])[0]

    def read(self, names: Sequence[str] = OUTPUTS) -> np.ndarray:
        return np.array(self.slave.getReal([self.fmu.variables[name].valueReference for name in names]))

    def force_rate(self) -> float:
        """dF_t/dt [N/s] at the present time."""
        reference, order, value = (c_uint * 1)(3), (c_int * 1)(1), (c_double * 1)()
        reference[0] = self.fmu.variables["F_t"].valueReference
        self._call(self.slave.fmi2GetRealOutputDerivatives, self.slave.component, reference, 1, order, value)
        return value[0]

    def close(self) -> None:
        if self.slave.component is not None:
            self.slave.fmi2FreeInstance(self.slave.component)
            self.slave.component = None

    def __enter__(self) -> Session:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def simulate(
    fmu: FrictionFmu,
    start_values: Mapping[str, Value],
    step: float,
    count: int,
    inputs: Mapping[str, Sequence[float]] | None = None,
    linear: bool = False,
    start: float = 0.0,
    outputs: Sequence[str] = OUTPUTS,
) -> dict[str, np.ndarray]:
    """count steps of the length step [s]; arrays of count + 1 points, "time" among them.

    inputs: count + 1 samples of any of V, d, E at the communication points; held over each step, or linear
    between them. Before the first step F_t_mean equals what the FMU gives at the start.
    """
    inputs = inputs or {}
    first = {name: samples[0] for name, samples in inputs.items()}
    rows = np.empty((count + 1, len(outputs)))
    with fmu.session({**start_values, **first}, start) as session:
        rows[0] = session.read(outputs)
        for k in range(count):
            for name, samples in inputs.items():
                session.set(name, samples[k])
            if linear and inputs:
                session.set_rates(**{name: (v[k + 1] - v[k]) / step for name, v in inputs.items()})
            session.step(step)
            rows[k + 1] = session.read(outputs)
    return {"time": start + step * np.arange(count + 1), **dict(zip(outputs, rows.T, strict=True))}
