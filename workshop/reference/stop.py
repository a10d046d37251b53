"""Bounded bristles, event by event: ElasticPlastic, and Dahl and LuGre where the limit follows the load.

    free: delta' = V - r delta while |delta| < D(t),  D = B / sigma
    slip: delta = s D while s V - k |V| - D' > 0

r = k = 0 and B = g in ElasticPlastic (the stop operator of Prandtl); else r = sigma |V| / g, k = B / g, and B
is the largest g at any V. How far a free bristle is beyond a bound follows p' = (s V - k |V| - D') - r p. So
between two zeros of that rate it meets each bound once at most; they divide the step like reversals of V.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, gauss_arrays, multiprecision
from workshop.reference.jet import JETS, Jet, at
from workshop.reference.mesh import graded_mesh, longest_piece
from workshop.reference.quadrature import AffineMap, piece_maps
from workshop.reference.scene import Drive, Scene, events

REAL = EXTENDED.real
SIDES = (1, -1)


def project(scene: Scene, t0: Any, delta_0: Any) -> tuple[Any, Any]:
    """The deflection inside its bound at t0, and the heat of the jump: the stored energy it gives up [J]."""
    drive, zero = Drive(scene, t0, EXTENDED), REAL(0)
    delta_0, bound = REAL(delta_0), drive.bound(zero)
    inside = min(max(delta_0, -bound), bound)
    return inside, drive.sigma(zero) * (delta_0 - inside) * (delta_0 + inside) / 2


def advance(scene: Scene, t0: Any, h: Any, delta_0: Any) -> tuple[Any, Any, Any, Any]:
    """Deflection [m], impulse [N s], work and heat [J] from t0 [s] over h [s].

    A delta_0 beyond the bound slips onto it at once: its energy turns to heat, and no impulse comes of it.
    """
    drive = Drive(scene, t0, EXTENDED)
    delta, jump_heat = project(scene, t0, delta_0)
    slip = int(np.sign(delta)) if abs(delta) >= drive.bound(REAL(0)) else 0
    sums = np.array([REAL(0), REAL(0), jump_heat])
    mesh = _mesh(scene, t0, REAL(h))
    leaves = {side: _outward(Drive(scene, t0, JETS), mesh[:-1] / 2 + mesh[1:] / 2, side) for side in SIDES}
    slips = []
    for k, ((begin, end), free) in enumerate(zip(pairwise(mesh), piece_maps(drive, mesh), strict=True)):
        open_sides = [side for side in SIDES if leaves[side].value[k] > 0]
        if slip not in open_sides:
            slip, begin, delta, part = _free(drive, free, begin, end, delta, open_sides)
            sums += part
        if slip:
            slips.append((slip, begin, end))
            delta = slip * drive.bound(end)
    return (delta, *(sums + _integrals_of_slip(scene, t0, slips)))


def rate(scene: Scene, t: Any, delta: Any) -> Any:
    """delta' [m/s] at the time t, as it was just before."""
    jets, tau, delta = Drive(scene, t, JETS), at(REAL(0)), REAL(delta)
    bound, side = jets.bound(tau), int(np.sign(delta))
    if abs(delta) >= bound.value * (1 - REAL(1e-15)) and _outward(jets, REAL(0), side).value > 0:
        return multiprecision(side * bound.first)
    drive = Drive(scene, t, EXTENDED)
    return multiprecision(drive.V(REAL(0)) - drive.relaxation_rate(REAL(0)) * delta)


def _outward(jets: Drive, times: Any, side: int) -> Jet:
    """How fast [m/s] a bristle on this bound would leave through it by its own law, and that one's slope."""
    tau = at(times)
    V, bound = jets.V(tau), jets.bound(tau)
    return side * V - abs(V) * jets.bound_over_limit(tau) - Jet(bound.first, bound.second)


def _free(
    drive: Drive, whole: AffineMap, begin: Any, end: Any, delta: Any, open_sides: list[int]
) -> tuple[int, Any, Any, list]:
    """Which bound is met, when, deflection and integrals up to there; or 0 and those of the whole piece."""

    def until(time: Any) -> tuple[Any, Any, Any, Any]:
        (part,) = piece_maps(drive, np.array([begin, time]))
        return part.apply(delta)

    for side in open_sides:
        if side * whole.apply(delta)[0] > drive.bound(end):
            time = _crossing(lambda t, side=side: side * until(t)[0] - drive.bound(t), begin, end)
            met, *integrals = until(time)
            return side, time, met, integrals
    reached, *integrals = whole.apply(delta)
    return 0, end, reached, integrals


def _crossing(function: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Where a function passes zero from below: regula falsi (Illinois) kept short by bisection."""
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


def _mesh(scene: Scene, t0: Any, h: Any) -> np.ndarray:
    """Pieces in which no bound turns round, fine behind the times where one does."""
    turns = [multiprecision(time) for time in _turning_times(scene, t0, h)]
    return np.unique(EXTENDED.array(graded_mesh(scene, t0, multiprecision(h), layers=turns)))


def _turning_times(scene: Scene, t0: Any, h: Any) -> Iterable[Any]:
    """Where the rate of leaving through a bound changes its sign."""
    jets, drive = Drive(scene, t0, JETS), Drive(scene, t0, MULTIPRECISION)
    whole = multiprecision(h)
    count = max(32, int(MP.ceil(8 * whole / longest_piece(scene, drive, MP.mpf(0), whole))))
    even = h * np.arange(count + 1, dtype=np.longdouble) / count
    grid = np.union1d(even, EXTENDED.array(events(drive, whole)))
    for side in SIDES:
        # the rate is monotone between the zeros of its slope, so no pair of its zeros is missed
        extremes = _zeros(lambda t, side=side: _outward(jets, t, side).first, grid, 24)
        yield from _zeros(lambda t, side=side: _outward(jets, t, side).value, np.union1d(grid, extremes), 44)


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
    return low + (high - low) / 2


def _integrals_of_slip(scene: Scene, t0: Any, slips: list[tuple[int, Any, Any]]) -> Any:
    """Impulse, work and heat along the bounds, by Gauss quadrature of smooth pieces."""
    if not slips:
        return np.zeros(3, dtype=np.longdouble)
    drive, rule = Drive(scene, t0, JETS), gauss_arrays(EXTENDED.nodes, EXTENDED)
    side, begin, end = np.array(slips, dtype=np.longdouble).T[:, :, None]
    tau, time = at(begin + (end - begin) * rule.nodes), (end - begin) * rule.weights
    V, bound = drive.V(tau).value, drive.bound(tau)
    elastic = side * drive.sigma(tau).value * bound.value
    force = elastic + drive.sigma_1 * side * bound.first + drive.sigma_2 * V
    heat = force * V - elastic * side * bound.first
    return np.array([(time * force).sum(), (time * force * V).sum(), (time * heat).sum()])
