"""`ModelExchange`: a contact and states of its host, advanced together by an integrator of scipy."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from ctypes import Array, c_double, c_uint
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import fmi2
from fmpy.fmi1 import FMICallException
from scipy.integrate import BDF, DenseOutput, OdeSolver

from frictioncontact.fmu import Closing, FrictionError, FrictionFmu, Loaded, logging_callbacks, opened
from frictioncontact.values import Value, real

Inputs, Rates = Callable[[float, np.ndarray], Mapping[str, float]], Callable[..., Sequence[float]]
STATES = 4  # delta, W_f, Q_f, delta_y


class FMU2Bristle(Loaded, fmi2.FMU2Model):
    """In model exchange."""


class ModelExchange(Closing):
    """One contact in model exchange beside states of the host, which one integrator advances together.

    start      start values by name, SI units
    own        start values of the host's own states, whose sizes are nominals (1 if not given)
    inputs     (t, own) -> the FMU's inputs by name; what it does not name stays as it is
    rates      (t, own, F_t) -> rates of the own states; after t and own the values of outputs
    tolerance  relative, of the integrator, which is method, a class of scipy.integrate
    fmu        another .fmu file of this model, or a `FrictionFmu`
    raises     UserError: a name or a value is wrong; FrictionError: the FMU or the integrator refuses

    `time` [s], `own`, `events` and `longest`, the longest step [s], are what `advance` has reached.

        import frictioncontact as fc
        scene = {"friction.model": "ElasticPlastic", "V": 0.0, "vibration.V_1": 0.5}
        mass = {"inputs": lambda t, own: {"V": own[0]}, "rates": lambda t, own, F_t: [(15.0 - F_t) / 2.0]}
        with fc.ModelExchange(scene, own=[0.0], **mass) as pulled:
            pulled.advance(2e-3)
            print(pulled.own[0], pulled.get("F_t"))
    """

    Model = FMU2Bristle

    def __init__(
        self,
        start: Mapping[str, Value],
        *,
        own: Sequence[float] = (),
        inputs: Inputs = lambda t, own: {},
        rates: Rates = lambda t, own, *outputs: (),
        outputs: Sequence[str] = ("F_t",),
        nominals: Sequence[float] | None = None,
        tolerance: float = 1e-6,
        method: type[OdeSolver] = BDF,
        fmu: str | Path | FrictionFmu | None = None,
    ) -> None:
        self.fmu = fmu if isinstance(fmu, FrictionFmu) else opened(fmu)
        self.time, self.own, self.events, self.longest = 0.0, np.array(own, float), 0, 0.0
        self._inputs, self._own_rates, self._method = inputs, rates, method
        self._tolerance = real(tolerance, "tolerance")
        self._own_nominals = np.ones(len(self.own)) if nominals is None else np.array(nominals, float)
        self._outputs, self._buffer = self._references(outputs), (c_double * STATES)()
        self._solver: OdeSolver | None = None
        self._ahead: tuple[float, np.ndarray, DenseOutput, bool] | None = None  # a step not yet completed
        self.messages: list[str] = []
        self._callbacks = logging_callbacks(self.messages)
        self._model: Any = self.Model(self.fmu.description, self.fmu.directory, self.fmu.library)
        self._model.instantiate(callbacks=self._callbacks)
        self._call(self._initialize, {**start, **inputs(0.0, self.own)})

    def _initialize(self, values: Mapping[str, Value]) -> None:
        self._model.setupExperiment()
        for name, value in values.items():
            number, variable = self.fmu.known.number(name, value, "start"), self.fmu.variables[name]
            is_real = variable.type == "Real"
            put = self._model.setReal if is_real else self._model.setInteger
            put([variable.valueReference], [number if is_real else int(number)])
        self._model.enterInitializationMode()
        self._model.exitInitializationMode()
        self._update()

    def _call(self, function: Callable[[Any], None], argument: Any) -> None:
        """Of a call that the FMU refuses its own message."""
        try:
            function(argument)
        except FMICallException as error:
            raise FrictionError("; ".join(self.messages) or str(error)) from None

    def _references(self, names: Iterable[str]) -> Array[c_uint]:
        found = [self.fmu.known.readable(name, "model exchange").valueReference for name in names]
        return (c_uint * len(found))(*found)

    def _update(self) -> None:
        """The end of an event, and the time of the next one that the FMU announces."""
        *_, announced, time = self._model.newDiscreteStates()
        self._next_event = time if announced else np.inf
        self._model.enterContinuousTimeMode()

    def _set_inputs(self) -> None:
        if values := self._inputs(self.time, self.own):
            self._model.setReal(self._references(values), list(values.values()))

    def _put(self, t: float, y: np.ndarray) -> None:
        self.time, self.own = t, y[STATES:]
        self._model.setTime(t)
        self._model.setContinuousStates((c_double * STATES)(*y[:STATES]), STATES)
        self._set_inputs()

    def _rates(self, t: float, y: np.ndarray) -> list[float]:
        self._put(t, y)
        self._model.getDerivatives(self._buffer, STATES)
        rates = list(self._buffer)
        return [*rates, *self._own_rates(t, self.own, *self._model.getReal(self._outputs))]

    def _signs(self, t: float, y: np.ndarray) -> list[bool]:
        self._put(t, y)
        self._model.getEventIndicators(self._buffer, STATES)
        return [indicator > 0.0 for indicator in self._buffer]

    def advance(self, stop: float) -> None:
        """To the time stop [s], by way of the events. An event is where an indicator has its new sign.

        The integrator steps past stop, and what it found there serves the next call: call `event` where a
        rule of inputs or rates changes.
        """
        while self.time < stop:
            self._call(self._onward, stop)

    def _onward(self, stop: float) -> None:
        """To stop, or to the end of the integrator's step and through the event there."""
        if self._ahead is None:
            self._ahead = self._step()
        end, y, course, event = self._ahead
        if stop < end:
            self._put(stop, course(stop))
            return
        self._ahead = None
        self._put(end, y)
        event |= bool(self._model.completedIntegratorStep()[0])
        if event or end >= self._next_event:
            self.event()

    def _step(self) -> tuple[float, np.ndarray, DenseOutput, bool]:
        """A step of the integrator, up to an event in it: end, states there and between, whether an event."""
        if self._solver is None:
            self._solver = self._new_solver()
        solver = self._solver
        if message := solver.step():
            raise FrictionError(f"the integrator stopped at {self.time:g} s: {message}")
        low, t, y, course = solver.t_old, solver.t, solver.y, solver.dense_output()
        self.longest = max(self.longest, t - low)
        event = self._signs(t, y) != self._before
        if event:
            while low < (middle := 0.5 * (low + t)) < t:
                before = self._signs(middle, course(middle)) == self._before
                low, t = (middle, t) if before else (low, middle)
            y = course(t)
        return t, y, course, event

    def _new_solver(self) -> OdeSolver:
        """From here to the next event that the FMU announces."""
        self._model.getContinuousStates(self._buffer, STATES)
        y = np.array([*self._buffer, *self.own])
        self._model.getNominalsOfContinuousStates(self._buffer, STATES)
        atol = self._tolerance * np.array([*self._buffer, *self._own_nominals])
        self._before = self._signs(self.time, y)
        return self._method(self._rates, self.time, y, self._next_event, rtol=self._tolerance, atol=atol)

    def event(self) -> None:
        """An event now, as after an input that jumps."""
        self.events += 1
        self._solver = self._ahead = None
        self._model.enterEventMode()
        self._set_inputs()
        self._update()

    def get(self, name: str) -> float:
        """The value of any variable of type Real now, SI units."""
        return float(self._model.getReal(self._references([name]))[0])

    def close(self) -> None:
        """Frees the instance."""
        if self._model.component is not None:
            self._model.fmi2FreeInstance(self._model.component)
            self._model.component = None
