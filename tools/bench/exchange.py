"""A mass on a belt in model exchange: its error against its cost, beside the masters of co-simulation.

    .venv/bin/python -m tools.bench.exchange      prints the table

The belt of `coupling`, with Dahl's law and with ElasticPlastic, under which the mass sticks truly. In model
exchange an integrator of scipy (BDF) takes bristle and mass together. Cost is the number of calls of all
functions of the FMU. Errors are the largest at 250 points: of F_t over F_C, of x over F_C / k.
"""

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from frictioncontact.exchange import FMU2Bristle, ModelExchange
from frictioncontact.fmu import FrictionFmu
from tools.bench.coupling import COUPLINGS, Belt, acceleration, cosimulate, largest_errors, monolithic
from tools.build import build_fmu

LAWS = ("Dahl", "ElasticPlastic")
TOLERANCES = (1e-4, 1e-6, 1e-8)
STEPS = (2000, 8000, 32000)
POINTS = 250
CALLS = {"F_t held": 3, "F_t linear": 5}  # in a step of co-simulation: set V, step, get F_t; and both rates
MODEL_EXCHANGE = "model exchange"


def reference(belt: Belt) -> np.ndarray:
    """Rows of x, v, F_t at the points."""
    return monolithic(belt)(np.linspace(0.0, belt.end, POINTS + 1)).T


@dataclass(frozen=True)
class Run:
    rows: np.ndarray  # x, v, F_t at POINTS + 1 times
    calls: int  # of all functions of the FMU
    evaluations: float = 0.0  # calls of fmi2GetDerivatives
    events: int = 0


class FMU2Counted(FMU2Bristle):
    """Counts the calls of the FMU's functions."""

    calls = 0

    def _call(self, *arguments: Any) -> Any:
        self.calls += 1
        return super()._call(*arguments)


class CountedExchange(ModelExchange):
    Model = FMU2Counted


def exchange(fmu: FrictionFmu, belt: Belt, tolerance: float) -> Run:
    """The belt in model exchange; the host's own states are x and v."""

    def rates(t: float, own: np.ndarray, F_t: float) -> tuple[float, float]:
        x, v = own
        return v, acceleration(belt, x, v, F_t)

    with CountedExchange(
        belt.start_values,
        own=(0.0, 0.0),
        inputs=lambda t, own: {"V": belt.V(t) - own[1]},
        rates=rates,
        nominals=(belt.F_C / belt.k, belt.V_a),
        tolerance=tolerance,
        fmu=fmu,
    ) as host:
        rows = [(0.0, 0.0, host.get("F_t"))]
        for n in range(1, POINTS + 1):
            host.advance(belt.end * n / POINTS)
            rows.append((*host.own, host.get("F_t")))
        calls = host._model.calls
        return Run(np.array(rows), calls, host.get("solver.evaluations"), host.events)


def simulate(fmu: FrictionFmu, belt: Belt, coupling: str, count: int) -> Run:
    """The same in co-simulation with a Jacobi master."""
    rows = cosimulate(fmu, belt, coupling, belt.end / count, count)
    return Run(rows[:: count // POINTS], CALLS[coupling] * count)


def errors(belt: Belt, run: Run, truth: np.ndarray) -> tuple[float, float]:
    return largest_errors(belt, run.rows, truth)


def against_cost(fmu: FrictionFmu) -> list[dict[str, object]]:
    """As coupling.coupled_errors, of Dahl's law: H is the simulated time over the evaluations."""
    belt = Belt()
    truth = reference(belt)
    rows: list[dict[str, object]] = []
    for tolerance in TOLERANCES:
        run = exchange(fmu, belt, tolerance)
        of_F_t, of_x = errors(belt, run, truth)
        found = {"H": belt.end / run.evaluations, "error_F_t": of_F_t, "error_x": of_x}
        rows.append({"coupling": MODEL_EXCHANGE, **found, "failure": ""})
    return rows


def main() -> None:
    print(f"{'law':15}{'way':43}{'calls':>8}{'F_t / F_C':>12}{'k x / F_C':>12}{'events':>8}")
    with FrictionFmu(build_fmu()) as fmu:
        for belt in (Belt(law=law) for law in LAWS):
            for coupling, count in product(COUPLINGS, STEPS):
                show(belt, f"co-simulation, {coupling}, {count} steps", simulate(fmu, belt, coupling, count))
            for tolerance in TOLERANCES:
                show(belt, f"model exchange, tolerance {tolerance:g}", exchange(fmu, belt, tolerance))


def show(belt: Belt, way: str, run: Run) -> None:
    of_F_t, of_x = errors(belt, run, reference(belt))
    print(f"{belt.law:15}{way:43}{run.calls:8}{of_F_t:12.1e}{of_x:12.1e}{run.events or '':>8}")


if __name__ == "__main__":
    main()
