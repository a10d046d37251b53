"""A mass on a belt with the FMU and a Jacobi master: both sides take each step from the values at its start.

    m x'' = -k x - c x' + F_t,      V = V_belt - x',      V_belt = V_0 + V_a sin(2 pi f t)
    F_t held       the mass sees F_t, the FMU sees V, of the start of the step
    F_t linear     the mass sees F_t + t dF_t/dt (the FMU's output derivative), the FMU V + t dV/dt

Within a step the mass is integrated exactly (matrix exponential), so that the coupling alone is seen.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.integrate import OdeSolution, solve_ivp
from scipy.linalg import expm

from frictioncontact.fmu import FrictionError, FrictionFmu

CHATTER = 0.5  # of F_C: an error of F_t beyond this is no solution
COUPLINGS = ("F_t held", "F_t linear")
OF_REFERENCE = 1e-12  # tolerance of the reference


@dataclass(frozen=True)
class Belt:
    """A belt to and fro: the mass sticks after every reversal and slips until the next."""

    m: float = 1.0  # kg
    k: float = 1e4  # N/m
    c: float = 40.0  # N s/m
    V_0: float = 0.05  # m/s
    V_a: float = 0.3  # m/s
    f: float = 10.0  # Hz
    sigma: float = 1e6  # N/m
    F_C: float = 10.0  # N
    end: float = 0.25  # s
    law: str = "Dahl"  # or ElasticPlastic

    @property
    def start_values(self) -> dict[str, float | str]:
        contact = {"contact.model": "Constant", "contact.sigma": self.sigma}
        return {"friction.model": self.law, "F_C": self.F_C, **contact}

    def V(self, t: float) -> float:
        return self.V_0 + self.V_a * math.sin(2 * math.pi * self.f * t)

    def V_rate(self, t: float) -> float:
        return 2 * math.pi * self.f * self.V_a * math.cos(2 * math.pi * self.f * t)


def transition(belt: Belt, H: float) -> np.ndarray:
    """(x, v, F, F') at the start to (x, v) at the end of a step with F + t F'."""
    system = np.zeros((4, 4))
    system[0, 1] = 1.0
    system[1] = [-belt.k / belt.m, -belt.c / belt.m, 1.0 / belt.m, 0.0]
    system[2, 3] = 1.0
    return expm(system * H)[:2]


def acceleration(belt: Belt, x: float, v: float, F: float) -> float:
    return (F - belt.k * x - belt.c * v) / belt.m


def cosimulate(
    fmu: FrictionFmu, belt: Belt, coupling: str, H: float, count: int, x_0: float = 0.0
) -> np.ndarray:
    """Rows of x, v, F_t at the communication points; ends early when x is beyond all bounds."""
    linear = coupling == "F_t linear"
    step = transition(belt, H)
    x, v = x_0, 0.0
    rows = []
    with fmu.session({**belt.start_values, "V": belt.V(0.0)}) as session:
        F = session.get("F_t")
        rows.append((x, v, F))
        for n in range(count):
            session.set("V", belt.V(n * H) - v)
            rate = 0.0
            if linear:
                session.set_rates(V=belt.V_rate(n * H) - acceleration(belt, x, v, F))
                rate = session.force_rate()
            x, v = step @ (x, v, F, rate)
            session.step(H)
            F = session.get("F_t")
            rows.append((x, v, F))
            if not abs(x) < 1e6:
                break
    return np.array(rows)


Trajectory = Callable[[np.ndarray], np.ndarray]  # times to rows of x, v, F_t


@cache
def monolithic(belt: Belt) -> Trajectory:
    """Mass and bristle as one system, by DOP853 from event to event.

    ElasticPlastic: F' = sigma V while it sticks (side 0), F = side F_C while it slips. Dahl: side is the sign
    of V, F' = sigma (V - side V F / F_C).
    """
    dahl = belt.law == "Dahl"
    y, side = np.zeros(3), 1 if dahl else 0
    scale = np.array([belt.F_C / belt.k, belt.V_a, belt.F_C])

    def slope(t: float, y: np.ndarray) -> tuple[float, float, float]:
        x, v, F = y
        V = belt.V(t) - v
        stuck = belt.sigma * (V - side * V * F / belt.F_C) if dahl else belt.sigma * V * (side == 0)
        return v, acceleration(belt, x, v, F), stuck

    def event(t: float, y: np.ndarray) -> float:
        return side * (belt.V(t) - y[1]) if side else belt.F_C - abs(y[2])

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    how = {"rtol": OF_REFERENCE, "atol": OF_REFERENCE * scale, "events": event, "dense_output": True}
    how["max_step"] = belt.end / 2000  # what is interpolated is then off by less than 1e-9
    times, interpolants = [0.0], []
    while times[-1] < belt.end:
        piece = solve_ivp(slope, (times[-1], belt.end), y, "DOP853", **how)
        if not piece.success:
            raise ArithmeticError(f"the reference of the belt fails: {piece.message}")
        y = piece.y[:, -1].copy()
        times += [*piece.t[1:]]
        interpolants += piece.sol.interpolants
        if dahl:
            side = -side
        else:
            side = 0 if side else int(np.sign(y[2]))
            y[2] = side * belt.F_C if side else y[2]
    return OdeSolution(times, interpolants)


def coupled_errors(
    fmu: FrictionFmu, belt: Belt, reference: Trajectory, counts: Sequence[int]
) -> list[dict[str, object]]:
    """The largest errors against the communication step."""
    rows: list[dict[str, object]] = []
    for coupling in COUPLINGS:
        for count in counts:
            H = belt.end / count
            row: dict[str, object] = {"coupling": coupling, "H": H, "error_F_t": np.nan, "error_x": np.nan}
            rows.append(row)
            try:
                got = cosimulate(fmu, belt, coupling, H, count)
            except FrictionError as error:
                row["failure"] = str(error)
                continue
            of_F_t, of_x = largest_errors(belt, got, reference(H * np.arange(len(got))).T)
            failure = "chatters" if len(got) <= count or of_F_t > CHATTER else ""
            row |= {"error_F_t": of_F_t, "error_x": of_x, "failure": failure}
    return rows


def largest_errors(belt: Belt, rows: np.ndarray, right: np.ndarray) -> tuple[float, float]:
    """Of F_t over F_C, and of x over F_C / k."""
    x, _, F_t = np.abs(rows - right).max(axis=0).tolist()
    return F_t / belt.F_C, x * belt.k / belt.F_C


def stick_map(belt: Belt, coupling: str, H: float) -> np.ndarray:
    """One step of the coupling in stick, where delta' = V: (x, v, F) at the start to those at the end."""
    mass, sigma, linear = transition(belt, H), belt.sigma, coupling == "F_t linear"
    # dF/dt = sigma V = -sigma v;  dV/dt = -(F - k x - c v) / m
    F_rate = linear * np.array([0.0, -sigma, 0.0])
    V_rate = linear * np.array([belt.k, belt.c, -1.0]) / belt.m
    force = np.array([0.0, -sigma * H, 1.0]) + 0.5 * sigma * H**2 * V_rate
    return np.vstack([mass[:, :3] + np.outer(mass[:, 3], F_rate), force])


def theoretical_edge(belt: Belt, coupling: str) -> float:
    """The step H [s] at which the spectral radius of the stick map passes 1.

    Every F = k x at rest stays: one eigenvalue is 1 and is left out.
    """

    def grows(H: float) -> bool:
        values = np.linalg.eigvals(stick_map(belt, coupling, H))
        moving = np.delete(values, np.abs(values - 1.0).argmin())
        return bool(np.abs(moving).max() > 1.0)

    return _bisect(grows, 1e-6)


def coupled_edge(fmu: FrictionFmu, belt: Belt, coupling: str) -> float:
    """The same measured: does a small swing about rest, the belt at rest too, grow or die out?

    The swing is so small that the bristle only sticks: sigma |V| / F_C is far below all other rates.
    """
    x_0 = 1e-9 * belt.F_C / belt.sigma
    at_rest = replace(belt, V_0=0.0, V_a=0.0)

    def grows(H: float) -> bool:
        speed = np.abs(cosimulate(fmu, at_rest, coupling, H, 400, x_0)[:, 1])
        slides = speed.max() > 1e-6 * belt.V_a  # it grew until the bristle slid
        return bool(slides or speed[300:].max() > speed[200:300].max())

    return _bisect(grows, 0.5 * theoretical_edge(belt, coupling), 1e-3)


def _bisect(grows: Callable[[float], bool], low: float, precision: float = 1e-6) -> float:
    if grows(low):
        raise ArithmeticError(f"the coupling is unstable at H = {low:.3g} s already")
    high = low
    while not grows(high):
        low, high = high, 1.5 * high
        if high > 1e3:
            return float("inf")
    return edge(lambda H: not grows(H), low, high, precision)


def edge(holds: Callable[[float], bool], low: float, high: float, precision: float) -> float:
    """Up to where something holds, between low, where it does, and high, where it does not; by bisection."""
    while high / low > 1 + precision:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if holds(middle) else (low, middle)
    return (low * high) ** 0.5
