"""A mass on a belt in model exchange: its error against its cost, beside the masters of co-simulation.

    .venv/bin/python -m workshop.bench.exchange      prints the table

The belt of `coupling`, with Dahl's law and with ElasticPlastic, under which the mass sticks truly. In model
exchange a host's CVODE takes bristle and mass together. Cost is the number of calls of all functions of the
FMU. Errors are the largest at 250 points: of F_t over F_C, of x over F_C / k.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from frictioncontact.fmu import FrictionFmu, Value
from workshop.bench.coupling import Belt, acceleration, cosimulate
from workshop.build import build_fmu
from workshop.exchange import Host

LAWS = ("Dahl", "ElasticPlastic")
TOLERANCES = (1e-4, 1e-6, 1e-8)
STEPS = (2000, 8000, 32000)
POINTS = 250
CALLS = {"F_t held": 3, "F_t linear": 5}  # in a step of co-simulation: set V, step, get F_t; and both rates
MODEL_EXCHANGE = "model exchange"
OF_REFERENCE = 1e-12  # tolerance of the reference's pieces


@dataclass(frozen=True)
class LawBelt(Belt):
    law: str = "Dahl"

    @property
    def start_values(self) -> dict[str, Value]:
        return {**super().start_values, "friction.model": self.law}


@cache
def reference(belt: LawBelt) -> np.ndarray:
    """Rows of x, v, F_t at the points: mass and bristle as one system, by DOP853 from event to event.

    ElasticPlastic: F' = sigma V while it sticks (side 0), F = side F_C while it slips. Dahl: side is the sign
    of V, F' = sigma (V - side V F / F_C). Every piece ends at a point or an event: nothing is interpolated.
    """
    dahl = belt.law == "Dahl"
    y, side, t = np.zeros(3), 1 if dahl else 0, 0.0

    def slope(t: float, y: np.ndarray) -> tuple[float, float, float]:
        x, v, F = y
        V = belt.V(t) - v
        stuck = belt.sigma * (V - side * V * F / belt.F_C) if dahl else belt.sigma * V * (side == 0)
        return v, acceleration(belt, x, v, F), stuck

    def event(t: float, y: np.ndarray) -> float:
        return side * (belt.V(t) - y[1]) if side else belt.F_C - abs(y[2])

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    scale = np.array([belt.F_C / belt.k, belt.V_a, belt.F_C])
    rows = [tuple(y)]
    for end in belt.end / POINTS * np.arange(1, POINTS + 1):
        while t < end:
            how = {"method": "DOP853", "events": event, "rtol": OF_REFERENCE, "atol": OF_REFERENCE * scale}
            piece = solve_ivp(slope, (t, end), y, **how)
            if not piece.success and piece.status != 1:
                raise ArithmeticError(f"the reference of the belt fails: {piece.message}")
            t, y = piece.t[-1], piece.y[:, -1].copy()
            if piece.status == 1:
                side = _next_side(belt, side, y)
        rows.append(tuple(y))
    return np.array(rows)


def _next_side(belt: LawBelt, side: int, y: np.ndarray) -> int:
    if belt.law == "Dahl":
        return -side
    if side:
        return 0
    side = 1 if y[2] > 0.0 else -1
    y[2] = side * belt.F_C
    return side


@dataclass(frozen=True)
class Run:
    rows: np.ndarray  # x, v, F_t at POINTS + 1 times
    calls: int  # of all functions of the FMU
    evaluations: float = 0.0  # calls of fmi2GetDerivatives
    events: int = 0


def exchange(fmu: FrictionFmu, belt: LawBelt, tolerance: float) -> Run:
    """The belt in model exchange; the host's own states are x and v."""

    def rates(t: float, own: np.ndarray, F_t: float) -> tuple[float, float]:
        x, v = own
        return v, acceleration(belt, x, v, F_t)

    with Host(
        fmu,
        belt.start_values,
        lambda t, own: {"V": belt.V(t) - own[1]},
        tolerance=tolerance,
        own=(0.0, 0.0),
        own_nominals=(belt.F_C / belt.k, belt.V_a),
        own_rates=rates,
    ) as host:
        rows = [(0.0, 0.0, host.get("F_t")[0])]
        for n in range(1, POINTS + 1):
            host.advance(belt.end * n / POINTS)
            rows.append((*host.own, host.get("F_t")[0]))
        calls = host.calls
        return Run(np.array(rows), calls, host.get("solver.evaluations")[0], host.events)


def simulate(fmu: FrictionFmu, belt: LawBelt, coupling: str, count: int) -> Run:
    """The same in co-simulation with a Jacobi master."""
    rows = cosimulate(fmu, belt, coupling, belt.end / count, count)
    return Run(rows[:: count // POINTS], CALLS[coupling] * count)


def errors(belt: LawBelt, run: Run, truth: np.ndarray) -> tuple[float, float]:
    """Of F_t and x."""
    error = np.abs(run.rows - truth).max(0)
    return error[2] / belt.F_C, error[0] * belt.k / belt.F_C


def against_cost(fmu: FrictionFmu) -> list[dict[str, object]]:
    """As coupling.coupled_errors, of Dahl's law: H is the simulated time over the evaluations."""
    belt = LawBelt()
    truth = reference(belt)
    rows: list[dict[str, object]] = []
    for tolerance in TOLERANCES:
        run = exchange(fmu, belt, tolerance)
        of_F_t, of_x = errors(belt, run, truth)
        found = {"H": belt.end / run.evaluations, "error_F_t": float(of_F_t), "error_x": float(of_x)}
        rows.append({"coupling": MODEL_EXCHANGE, **found, "failure": ""})
    return rows


def table(fmu: FrictionFmu) -> Iterator[tuple[str, str, int, float, float, int]]:
    """Law, way, calls, errors of F_t and x, events."""
    for law in LAWS:
        belt = LawBelt(law=law)
        truth = reference(belt)
        for coupling in ("F_t held", "F_t linear"):
            for count in STEPS:
                run = simulate(fmu, belt, coupling, count)
                way = f"co-simulation, {coupling}, {count} steps"
                yield law, way, run.calls, *errors(belt, run, truth), 0
        for tolerance in TOLERANCES:
            run = exchange(fmu, belt, tolerance)
            way = f"model exchange, tolerance {tolerance:g}"
            yield law, way, run.calls, *errors(belt, run, truth), run.events


def main() -> None:
    print(f"{'law':15}{'way':43}{'calls':>8}{'F_t / F_C':>12}{'k x / F_C':>12}{'events':>8}")
    with FrictionFmu(build_fmu()) as fmu:
        for law, way, calls, of_F_t, of_x, events in table(fmu):
            print(f"{law:15}{way:43}{calls:8}{of_F_t:12.1e}{of_x:12.1e}{events or '':>8}")


if __name__ == "__main__":
    main()
