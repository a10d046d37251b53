"""FrictionContact.fmu in model exchange: an instance and states of the host's own, by CVODE with events.

    with FrictionFmu("build/FrictionContact.fmu") as fmu:
        host = Host(fmu, {"friction.model": "ElasticPlastic"}, lambda t, own: {"V": 0.1 * t}, tolerance=1e-8)
        host.advance(2.0)
        host.get("F_t", "W_f")

The integrator is the CVODE that fmpy brings (BDF, dense Jacobian by differences). Unlike `fmpy.simulate_fmu`
the host sets the inputs in every evaluation of the right-hand side. Times in s, everything in SI units.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from ctypes import Array, c_double, c_uint
from types import SimpleNamespace
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model
from fmpy.sundials import CVodeSolver

from frictioncontact.fmu import Closing, FrictionError, FrictionFmu, Value, logging_callbacks

Inputs = Callable[[float, np.ndarray], Mapping[str, float]]
Rates = Callable[..., Sequence[float]]
STATES = 4  # delta, W_f, Q_f, delta_y
MOST_STEPS = 1_000_000  # of CVODE on the way to one output


class Host(Closing):
    """One contact in model exchange and the host's own states, from start on.

    inputs(t, own) gives inputs of the FMU; what it does not name stays as it is. own_rates(t, own, *forces)
    gives the rates of the host's own states by these outputs of the FMU; own are the start values of the
    states, own_nominals their sizes.
    """

    def __init__(
        self,
        fmu: FrictionFmu,
        start_values: Mapping[str, Value],
        inputs: Inputs,
        *,
        tolerance: float,
        start: float = 0.0,
        longest_step: float = np.inf,
        own: Sequence[float] = (),
        own_nominals: Sequence[float] = (),
        own_rates: Rates | None = None,
        forces: Sequence[str] = ("F_t",),
    ) -> None:
        self.fmu = fmu
        self.time = start
        self.own = np.array(own, float)
        self.events = 0
        self._inputs, self._own_rates, self._own_nominals = inputs, own_rates, np.array(own_nominals, float)
        self._forces = self._references(forces)
        self._model = self._instantiated()
        try:
            self._start(start_values, start)
            self._solver = CVodeSolver(
                nx=STATES + len(self.own),
                nz=fmu.description.numberOfEventIndicators,
                get_x=self._get_states,
                set_x=self._set_states,
                get_dx=self._get_rates,
                get_z=self._model.getEventIndicators,
                get_nominals=self._get_nominals,
                set_time=self._set_time,
                input=SimpleNamespace(apply=lambda t: None),  # inputs are set with the states
                startTime=start,
                maxStep=longest_step,
                relativeTolerance=tolerance,
                maxNumSteps=MOST_STEPS,
            )
        except BaseException:
            self.close()
            raise

    @property
    def calls(self) -> int:
        """Of every function of the FMU since the start."""
        return self._model.calls

    def _references(self, names: Iterable[str]) -> Array[c_uint]:
        found = [self.fmu.variables[name].valueReference for name in names]
        return (c_uint * len(found))(*found)

    def _instantiated(self) -> FMU2Counted:
        model = FMU2Counted(
            guid=self.fmu.description.guid,
            modelIdentifier=self.fmu.description.modelExchange.modelIdentifier,
            unzipDirectory=str(self.fmu.directory),
            instanceName="contact",
        )
        self.messages: list[str] = []
        self._callbacks = logging_callbacks(self.messages)
        model.instantiate(callbacks=self._callbacks)
        return model

    def _start(self, start_values: Mapping[str, Value], start: float) -> None:
        self._model.setupExperiment(startTime=start)
        for name, value in {**start_values, **self._inputs(start, self.own)}.items():
            self._set(name, value)
        self._model.enterInitializationMode()
        try:
            self._model.exitInitializationMode()
        except FMICallException as error:
            raise FrictionError("; ".join(self.messages) or str(error)) from None
        self._update()

    def _update(self) -> None:
        """The end of an event, and the time of the next one that the FMU announces."""
        *_, announced, time = self._model.newDiscreteStates()
        self._next_event = time if announced else np.inf
        self._model.enterContinuousTimeMode()

    def _set(self, name: str, value: Value) -> None:
        variable, number = self.fmu.variables[name], self.fmu.known.number(name, value, "set")
        if variable.type == "Real":
            self._model.setReal([variable.valueReference], [number])
        else:
            self._model.setInteger([variable.valueReference], [int(number)])

    # What CVODE asks for; pointers are to as many doubles as there are states.

    def _set_inputs(self) -> None:
        values = self._inputs(self.time, self.own)
        if values:
            reals = (c_double * len(values))(*values.values())
            self._model.fmi2SetReal(self._model.component, self._references(values), len(values), reals)

    def _set_time(self, t: float) -> None:
        self.time = t
        self._model.setTime(t)

    def _set_states(self, x: Any, count: int) -> None:
        self.own = np.ctypeslib.as_array(x, (count,))[STATES:].copy()
        self._model.setContinuousStates(x, STATES)
        self._set_inputs()

    def _get_states(self, x: Any, count: int) -> None:
        self._model.getContinuousStates(x, STATES)
        np.ctypeslib.as_array(x, (count,))[STATES:] = self.own

    def _get_rates(self, rates: Any, count: int) -> None:
        self._model.getDerivatives(rates, STATES)
        if self._own_rates:
            forces = (c_double * len(self._forces))()
            self._model.fmi2GetReal(self._model.component, self._forces, len(forces), forces)
            own = self._own_rates(self.time, self.own, *forces)
            np.ctypeslib.as_array(rates, (count,))[STATES:] = own

    def _get_nominals(self, nominals: Any, count: int) -> None:
        self._model.getNominalsOfContinuousStates(nominals, STATES)
        np.ctypeslib.as_array(nominals, (count,))[STATES:] = self._own_nominals

    def advance(self, stop: float) -> None:
        """To the time stop, by way of the events."""
        while self.time < stop:
            at_event, _, reached = self._solver.step(self.time, min(stop, self._next_event))
            self._set_time(reached)
            self._set_inputs()
            wanted, _ = self._model.completedIntegratorStep()
            if at_event or wanted or reached >= self._next_event:
                self.event()

    def event(self) -> None:
        """An event now, as after an input that jumps."""
        self.events += 1
        self._model.enterEventMode()
        self._set_inputs()
        self._update()
        self._solver.reset(self.time)

    def get(self, *names: str) -> np.ndarray:
        return np.array(self._model.getReal(self._references(names)))

    def close(self) -> None:
        if self._model.component is not None:
            self._model.freeInstance()
            self._model.component = None


class FMU2Counted(FMU2Model):
    """Counts the calls of the FMU's functions. FMPy loads by the first letters of the class's name."""

    calls = 0

    def _call(self, *arguments: Any) -> Any:
        self.calls += 1
        return super()._call(*arguments)
