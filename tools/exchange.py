"""FrictionContact.fmu in model exchange by CVODE: the package's host with another integrator.

    with FrictionFmu("build/FrictionContact.fmu") as fmu:
        host = Host(fmu, {"friction.model": "ElasticPlastic"}, lambda t, own: {"V": 0.1 * t}, tolerance=1e-8)
        host.advance(2.0)
        host.get("F_t", "W_f")

The integrator is the CVODE that fmpy brings (BDF, dense Jacobian by differences). Unlike `fmpy.simulate_fmu`
the host sets the inputs in every evaluation of the right-hand side. Times in s, everything in SI units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from fmpy.sundials import CVodeSolver

from frictioncontact.exchange import STATES, FMU2Bristle, Inputs, ModelExchange, Rates
from frictioncontact.fmu import FrictionFmu, Value

MOST_STEPS = 1_000_000  # of CVODE on the way to one output


class FMU2Counted(FMU2Bristle):
    """Counts the calls of the FMU's functions."""

    calls = 0

    def _call(self, *arguments: Any) -> Any:
        self.calls += 1
        return super()._call(*arguments)


class Host(ModelExchange):
    """One contact in model exchange and the host's own states, from 0 on.

    inputs(t, own) gives inputs of the FMU; what it does not name stays as it is. own_rates(t, own, *forces)
    gives the rates of the host's own states by these outputs of the FMU; own are the start values of the
    states, own_nominals their sizes.
    """

    Model = FMU2Counted

    def __init__(
        self,
        fmu: FrictionFmu,
        start_values: Mapping[str, Value],
        inputs: Inputs,
        *,
        tolerance: float,
        longest_step: float = np.inf,
        own: Sequence[float] = (),
        own_nominals: Sequence[float] = (),
        own_rates: Rates = lambda t, own, *forces: (),
        forces: Sequence[str] = ("F_t",),
    ) -> None:
        super().__init__(
            start_values, own=own, inputs=inputs, rates=own_rates, outputs=forces, nominals=own_nominals,
            tolerance=tolerance, fmu=fmu,
        )  # fmt: skip
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
            startTime=0.0,
            maxStep=longest_step,
            relativeTolerance=tolerance,
            maxNumSteps=MOST_STEPS,
        )

    @property
    def calls(self) -> int:
        """Of every function of the FMU since the start."""
        return self._model.calls

    # What CVODE asks for; pointers are to as many doubles as there are states.

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
        if count > STATES:
            own = self._own_rates(self.time, self.own, *self._model.getReal(self._outputs))
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
        super().event()
        self._solver.reset(self.time)

    def get(self, *names: str) -> np.ndarray:  # type: ignore[override]
        """The values of several variables now."""
        return np.array(self._model.getReal(self._references(names)))
