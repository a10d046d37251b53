"""Bounded bristles, event by event: ElasticPlastic, and Dahl and LuGre where the limit follows the load.

    free: delta' = V - r delta while |delta| < D(t),  D = B / sigma
    slip: delta = s D while s V - k |V| - D' > 0

r = k = 0 and B = g in ElasticPlastic (the stop operator of Prandtl); else r = sigma |V| / g, k = B / g, and B
is the largest g at any V. How far a free bristle is beyond a bound follows p' = (s V - k |V| - D') - r p. So
between two zeros of that rate it meets each bound once at most; they divide the step like reversals of V.

With static friction ElasticPlastic has a second state, the side it slips to (0: it sticks). A bristle that
sticks breaks away at the static bound D_s and drops to the kinetic one, D. It slips until s V - D' <= 0.
"""

from collections.abc import Callable, Iterable
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, gauss_arrays, multiprecision
from workshop.reference.jet import JETS, Jet, at
from workshop.reference.mesh import graded_mesh, load_halvings, longest_piece
from workshop.reference.quadrature import AffineMap, piece_maps
from workshop.reference.scene import Drive, Scene, events

REAL = EXTENDED.real
SIDES = (1, -1)
MOST_BREAKS = 10_000  # in a piece


class Reached(NamedTuple):
    delta: Any  # m, at the end
    impulse: Any  # N s
    work: Any  # J
    heat: Any  # J
    slips: int  # the side it slips to where break-away is a drop, else 0
    has_slipped: bool  # in the step


def project(scene: Scene, t0: Any, delta_0: Any) -> tuple[Any, int, Any]:
    """A start: the deflection inside its bound at t0, the side it slips to and the heat of getting there [J].

    A limit that falls at the same stiffness has held delta_0 before: the stored energy turns to heat.
    """
    drive, zero = Drive(scene, t0, EXTENDED), REAL(0)
    delta_0, bound = REAL(delta_0), drive.bound(zero)
    if scene.drops and abs(delta_0) <= drive.static_bound(zero):
        return delta_0, 0, zero
    inside = min(max(delta_0, -bound), bound)
    slips = int(np.sign(delta_0)) if scene.drops else 0
    return inside, slips, drive.sigma(zero) * (delta_0 - inside) * (delta_0 + inside) / 2


def advance(scene: Scene, t0: Any, h: Any, delta_0: Any, slips: int = 0) -> Reached:
    """From t0 [s] over h [s], from a deflection within its bound."""
    march = _Drops if scene.drops else _Clamps
    mesh, maps = _mesh_and_maps(scene, t0, REAL(h))
    walk = march(scene, t0, mesh, REAL(delta_0), slips)
    for k, (piece, free) in enumerate(zip(pairwise(mesh), maps, strict=True)):
        walk.take(k, *piece, free)
    integrals = walk.sums + _integrals_of_slip(scene, t0, walk.slid)
    return Reached(walk.delta, *integrals, walk.slips if scene.drops else 0, walk.has_slipped)


def rate(scene: Scene, t: Any, delta: Any, slips: int = 0) -> Any:
    """delta' [m/s] at the time t, as it was just before."""
    jets, tau, delta = Drive(scene, t, JETS), at(REAL(0)), REAL(delta)
    bound, side = jets.bound(tau), slips if scene.drops else int(np.sign(delta))
    on_bound = side and side * delta >= bound.value * (1 - REAL(1e-15))
    if on_bound and _outward(jets, REAL(0), side).value > 0:
        return multiprecision(side * bound.first)
    drive = Drive(scene, t, EXTENDED)
    return multiprecision(drive.V(REAL(0)) - drive.relaxation_rate(REAL(0)) * delta)


class _Walk:
    """The state and the integrals up to the time reached."""

    def __init__(self, scene: Scene, t0: Any, mesh: np.ndarray, delta: Any, slips: int) -> None:
        self.scene, self.drive, self.delta, self.slips = scene, Drive(scene, t0, EXTENDED), delta, slips
        self.sums = np.array([REAL(0), REAL(0), REAL(0)])
        self.slid: list[tuple[int, Any, Any]] = []
        middles = mesh[:-1] / 2 + mesh[1:] / 2
        self.leaves = {side: _outward(Drive(scene, t0, JETS), middles, side).value for side in SIDES}

    @property
    def has_slipped(self) -> bool:
        return bool(self.slid)

    def free(self, whole: AffineMap, begin: Any, end: Any, bound: Callable, sides: Iterable[int]) -> tuple:
        """By the law alone to where it meets a bound of these sides: which (0: none) and when."""

        def until(time: Any) -> tuple[Any, Any, Any, Any]:
            (part,) = piece_maps(self.drive, np.array([begin, time]))
            return part.apply(self.delta)

        side, time, reached = 0, end, whole.apply(self.delta)
        for one in sides:
            if one * reached[0] > bound(end):
                side = one
                time = _crossing(lambda t, side=side: side * until(t)[0] - bound(t), begin, end)
                reached = until(time) if time > begin else (self.delta, 0, 0, 0)
                break
        self.delta, *integrals = reached
        self.sums += integrals
        return side, time

    def slide(self, side: int, begin: Any, end: Any) -> None:
        self.slid.append((side, begin, end))
        self.delta = side * self.drive.bound(end)


class _Clamps(_Walk):
    def __init__(self, scene: Scene, t0: Any, mesh: np.ndarray, delta: Any, slips: int) -> None:
        super().__init__(scene, t0, mesh, delta, slips)
        self.slips = int(np.sign(delta)) if abs(delta) >= self.drive.bound(REAL(0)) else 0

    def take(self, k: int, begin: Any, end: Any, whole: AffineMap) -> None:
        open_sides = [side for side in SIDES if self.leaves[side][k] > 0]
        if self.slips not in open_sides:
            self.slips, begin = self.free(whole, begin, end, self.drive.bound, open_sides)
        if self.slips:
            self.slide(self.slips, begin, end)


class _Drops(_Walk):
    def __init__(self, scene: Scene, t0: Any, mesh: np.ndarray, delta: Any, slips: int) -> None:
        super().__init__(scene, t0, mesh, delta, slips)
        middles, jets = mesh[:-1] / 2 + mesh[1:] / 2, Drive(scene, t0, JETS)
        self.breaks = {side: _outward_static(jets, middles, side).value for side in SIDES}
        self.broken = False

    @property
    def has_slipped(self) -> bool:
        return self.broken or bool(self.slid)

    def take(self, k: int, begin: Any, end: Any, whole: AffineMap) -> None:
        for _ in range(MOST_BREAKS):
            if self.slips and self.leaves[self.slips][k] <= 0:
                self.slips = 0
            if begin >= end:
                return
            if self.slips:
                begin = self._slip(begin, end, whole)
            else:
                sides = [side for side in SIDES if self.breaks[side][k] > 0]
                self.slips, begin = self.free(whole, begin, end, self.drive.static_bound, sides)
                if self.slips:
                    self._drop(begin)
            if begin < end:
                (whole,) = piece_maps(self.drive, np.array([begin, end]))
        raise ArithmeticError("it breaks away again and again")

    def _slip(self, begin: Any, end: Any, whole: AffineMap) -> Any:
        """On the kinetic bound, or up to it where a jump left the bristle inside."""
        bound = self.drive.bound(begin)
        if self.slips * self.delta >= bound * (1 - REAL(1e-17)):
            self.slide(self.slips, begin, end)
            return end
        return self.free(whole, begin, end, self.drive.bound, [self.slips])[1]

    def _drop(self, time: Any) -> None:
        drive, static, kinetic = self.drive, self.drive.static_bound(time), self.drive.bound(time)
        damping = -self.slips * drive.sigma_1 * (static - kinetic)
        self.sums += [
            damping,
            damping * drive.V(time),
            damping * drive.V(time) + drive.sigma(time) * (static - kinetic) * (static + kinetic) / 2,
        ]
        self.delta, self.broken = self.slips * kinetic, True


def _outward(jets: Drive, times: Any, side: int) -> Jet:
    """How fast [m/s] a bristle on this bound would leave through it by its own law, and that one's slope."""
    tau = at(times)
    V, bound = jets.V(tau), jets.bound(tau)
    return side * V - abs(V) * jets.bound_over_limit(tau) - Jet(bound.first, bound.second)


def _outward_static(jets: Drive, times: Any, side: int) -> Jet:
    """The same of the static bound."""
    tau = at(times)
    bound = jets.static_bound(tau)
    return side * jets.V(tau) - Jet(bound.first, bound.second)


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


@lru_cache(maxsize=1)  # the search for a settled state goes through one period from many deflections
def _mesh_and_maps(scene: Scene, t0: Any, h: Any) -> tuple[np.ndarray, list[AffineMap]]:
    """Pieces in which no bound turns round, fine behind the times where one does; and their maps."""
    turns = [multiprecision(time) for time in _turning_times(scene, t0, h)]
    mesh = np.unique(EXTENDED.array(graded_mesh(scene, t0, multiprecision(h), layers=turns)))
    return mesh, list(piece_maps(Drive(scene, t0, EXTENDED), mesh))


def _turning_times(scene: Scene, t0: Any, h: Any) -> Iterable[Any]:
    """Where the rate of leaving through a bound changes its sign."""
    jets, drive = Drive(scene, t0, JETS), Drive(scene, t0, MULTIPRECISION)
    whole = multiprecision(h)
    corners, grid = [MP.mpf(0), *load_halvings(drive, whole), whole], [EXTENDED.array(events(drive, whole))]
    for left, right in pairwise(corners):
        count = max(32, int(MP.ceil(8 * (right - left) / longest_piece(scene, drive, left, right))))
        begin, size = REAL(left), REAL(right) - REAL(left)
        grid.append(begin + size * np.arange(count + 1, dtype=np.longdouble) / count)
    grid = np.unique(np.concatenate(grid))
    for outward in (_outward, _outward_static) if scene.drops else (_outward,):
        for side in SIDES:
            # the rate is monotone between the zeros of its slope, so no pair of its zeros is missed
            extremes = _zeros(lambda t, o=outward, side=side: o(jets, t, side).first, grid, 24)
            dense = np.union1d(grid, extremes)
            yield from _zeros(lambda t, o=outward, side=side: o(jets, t, side).value, dense, 44)


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
