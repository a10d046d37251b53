"""ElasticPlastic, event by event: the stop operator of Prandtl with a bound that moves.

    stick: delta' = V while |delta| < D(t),  D = g / sigma
    slip:  delta = s D until s (V - s D') falls below zero

While it sticks, delta moves with X, the integral of V. The times where X - D and X + D turn round divide
the step; between them both are monotone, so each bound is met once at most and the state machine is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from frictionlab.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, gauss_rule, multiprecision
from frictionlab.reference.jet import JETS, Jet, at
from frictionlab.reference.mesh import longest_piece
from frictionlab.reference.scene import Drive, Scene

REAL = EXTENDED.real


@dataclass(frozen=True)
class Phase:
    """Stick (slip = 0) or slip along the upper (1) or lower (-1) bound, on local times."""

    slip: int
    begin: Any
    end: Any
    delta: Any  # where it sticks: the deflection at the time origin
    origin: Any


def project(scene: Scene, t0: Any, delta_0: Any) -> tuple[Any, Any]:
    """The deflection inside its bound at t0, and the heat of the jump: the stored energy it gives up [J]."""
    drive, zero = Drive(scene, t0, EXTENDED), REAL(0)
    delta_0, sigma = REAL(delta_0), drive.sigma(zero)
    bound = drive.limit(zero) / sigma
    inside = min(max(delta_0, -bound), bound)
    return inside, sigma * (delta_0 - inside) * (delta_0 + inside) / 2


def advance(scene: Scene, t0: Any, h: Any, delta_0: Any) -> tuple[Any, Any, Any, Any]:
    """Deflection [m], impulse [N s], work and heat [J] from t0 [s] over h [s].

    A delta_0 beyond the bound slips onto it at once: its energy turns to heat, and no impulse comes of it.
    """
    h = REAL(h)
    drive = Drive(scene, t0, EXTENDED)
    delta, jump_heat = project(scene, t0, delta_0)
    phases = _phases(scene, drive, t0, h, delta)
    last = phases[-1]
    delta = last.slip * _bound(drive, h) if last.slip else last.delta + drive.travel(last.origin, h)
    impulse, work, heat = _integrals(scene, t0, phases)
    return delta, impulse, work, heat + jump_heat


def rate(scene: Scene, t: Any, delta: Any) -> Any:
    """delta' [m/s] at the time t, as it was just before."""
    tau = at(REAL(0))
    drive = Drive(scene, t, JETS)
    V, bound = drive.V(tau).value, drive.limit(tau) / drive.sigma(tau)
    side = np.sign(REAL(delta))
    slips = abs(REAL(delta)) >= bound.value * (1 - REAL(1e-15)) and side * V > bound.first
    return multiprecision(REAL(side * bound.first if slips else V))


def _bound(drive: Drive, tau: Any) -> Any:
    return drive.limit(tau) / drive.sigma(tau)


def _rates(drive: Drive, times: Any) -> tuple[Jet, Jet]:
    """X' - D' and X' + D', with one derivative more than they need."""
    tau = at(times)
    bound = drive.limit(tau) / drive.sigma(tau)
    V = drive.V(tau)
    slope = Jet(bound.first, bound.second)
    return V - slope, V + slope


def _phases(scene: Scene, drive: Drive, t0: Any, h: Any, delta: Any) -> list[Phase]:
    jets = Drive(scene, t0, JETS)
    corners = _turning_times(jets, scene, h)
    middles = (corners[1:] + corners[:-1]) / 2
    leaving_up, leaving_down = (rate.value for rate in _rates(jets, middles))
    at_bound = _bound(drive, REAL(0))
    slip = 1 if delta >= at_bound else -1 if delta <= -at_bound else 0
    origin = corners[0]
    phases: list[Phase] = []
    for k in range(len(middles)):
        begin, end = corners[k], corners[k + 1]
        outward = {1: leaving_up[k] > 0, -1: leaving_down[k] < 0}
        if slip and not outward[slip]:
            delta, origin, slip = slip * _bound(drive, begin), begin, 0
        if not slip:
            slip, time = _first_slip(drive, Phase(0, begin, end, delta, origin), outward)
            if time > begin:
                phases.append(Phase(0, begin, time, delta, origin))
                begin = time
        if slip and begin < end:
            phases.append(Phase(slip, begin, end, delta, origin))
    return phases


def _first_slip(drive: Drive, stick: Phase, outward: dict[int, Any]) -> tuple[int, Any]:
    """Which bound a sticking contact meets, and when; 0 and the end if none."""
    for side in (1, -1):

        def beyond(t: Any, side: int = side) -> Any:
            return side * (stick.delta + drive.travel(stick.origin, t)) - _bound(drive, t)

        if outward[side] and beyond(stick.end) > 0:
            return side, _crossing(beyond, stick.begin, stick.end)
    return 0, stick.end


def _crossing(function: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Where an increasing function passes zero: regula falsi (Illinois) kept short by bisection."""
    f_low, f_high = function(low), function(high)
    if f_low >= 0:
        return low
    for k in range(300):
        width = high - low
        middle = low + width / 2 if k % 3 == 2 else high - f_high * width / (f_high - f_low)
        if not low < middle < high:
            middle = low + width / 2
        if not low < middle < high:
            break
        f_middle = function(middle)
        if f_middle > 0:
            high, f_high, f_low = middle, f_middle, f_low / 2
        else:
            low, f_low, f_high = middle, f_middle, f_high / 2
        if f_middle == 0:
            return middle
    return high


def _turning_times(jets: Drive, scene: Scene, h: Any) -> np.ndarray:
    """0, h and the times between where X - D or X + D turns round, increasing."""
    grid = _grid(scene, jets, h)
    times = [grid[:1], grid[-1:]]
    for side in (0, 1):
        # the rate is monotone between the zeros of its derivative, so no pair of its zeros is missed
        extremes = _zeros(lambda t, side=side: _rates(jets, t)[side].first, grid, 24)
        finer = np.union1d(grid, extremes)
        times.append(_zeros(lambda t, side=side: _rates(jets, t)[side].value, finer, 44))
    return np.unique(np.concatenate(times))


def _grid(scene: Scene, jets: Drive, h: Any) -> np.ndarray:
    piece = _longest(scene, jets.t0, h) / 8
    count = max(32, int(np.ceil(h / piece)))
    return h * np.arange(count + 1, dtype=np.longdouble) / count


def _longest(scene: Scene, t0: Any, h: Any) -> Any:
    return REAL(longest_piece(scene, Drive(scene, t0, MULTIPRECISION), MP.mpf(0), multiprecision(h)))


def _zeros(function: Callable[[Any], Any], grid: np.ndarray, halvings: int) -> np.ndarray:
    """Zeros between neighbours of opposite sign, all at once by bisection.

    Where a contact turns round, an error of time enters the deflection with its square.
    """
    values = function(grid)
    change = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)
    low, high = grid[change], grid[change + 1]
    rising = values[change + 1] > 0
    for _ in range(halvings):
        middle = low + (high - low) / 2
        above = (function(middle) > 0) == rising
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    exact = grid[1:-1][values[1:-1] == 0]
    return np.union1d(low + (high - low) / 2, exact) if change.size else exact


def _integrals(scene: Scene, t0: Any, phases: list[Phase]) -> tuple[Any, Any, Any]:
    """Impulse, work and heat by Gauss quadrature of smooth pieces."""
    drive = Drive(scene, t0, JETS)
    rule = gauss_rule(EXTENDED.nodes)
    x, weights = EXTENDED.array(rule.nodes), EXTENDED.array(rule.weights)
    longest = _longest(scene, t0, phases[-1].end)
    begin, size, slip, held, origin = [], [], [], [], []
    for phase in phases:
        count = max(1, int(np.ceil((phase.end - phase.begin) / longest)))
        width = (phase.end - phase.begin) / count
        begin += [phase.begin + k * width for k in range(count)]
        size += [width] * count
        slip += [phase.slip] * count
        held += [phase.delta] * count
        origin += [phase.origin] * count
    begin, size, slip, held, origin = (
        np.array(values, dtype=np.longdouble)[:, None] for values in (begin, size, slip, held, origin)
    )
    tau = at(begin + size * x[None, :])
    V, sigma = drive.V(tau).value, drive.sigma(tau)
    bound = drive.limit(tau) / sigma
    sticks = slip == 0
    stuck = held + Drive(scene, t0, EXTENDED).travel(origin, tau.value)
    delta = np.where(sticks, stuck, slip * bound.value)
    rate = np.where(sticks, V, slip * bound.first)
    elastic = sigma.value * delta
    force = elastic + drive.sigma_1 * rate + drive.sigma_2 * V
    time = size * weights
    return (time * force).sum(), (time * force * V).sum(), (time * (force * V - elastic * rate)).sum()
