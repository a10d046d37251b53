"""Where the deflection tends after infinitely many periods of held inputs, or after sliding for ever."""

from typing import Any, NamedTuple

import numpy as np

from workshop.reference import solution, stop
from workshop.reference.arithmetic import EXTENDED, MP, multiprecision
from workshop.reference.quadrature import interval_map
from workshop.reference.scene import Drive, Scene

REAL = EXTENDED.real
LONGEST_STICK = 2**40  # periods
MOST_SLIPS = 20  # periods of a cycle that slip


class Settled(NamedTuple):
    delta: Any  # m, at the phase of t0; where a cycle takes several periods, at the end of one that slips
    slips: int  # the side it slips to where break-away is a drop
    mean: Any  # N, of F_t over a period, or over the cycle


def settled(scene: Scene, t0: Any, delta_0: Any) -> Settled:
    """From delta_0 [m] at t0 [s]; delta_0 itself where nothing moves it."""
    if solution.is_open(scene, t0) or scene.friction == "Coulomb":
        return Settled(REAL(delta_0), 0, _mean(scene, t0, delta_0))
    if scene.drops and scene.vibrates:
        return _cycle(scene, t0, *stop.project(scene, t0, delta_0)[:2])
    tends_to, slips = _without_the_bound(scene, t0, REAL(delta_0)), 0
    if scene.bounded:
        tends_to, slips, _ = stop.project(scene, t0, tends_to)
        if scene.vibrates:
            # a period is a clamped affine map: its fixed point is where it takes that of the affine map
            tends_to = stop.advance(scene, t0, scene.period, tends_to).delta
        if scene.drops:
            slips = int(np.sign(scene.V))
    return Settled(tends_to, slips, _mean(scene, t0, tends_to))


def _mean(scene: Scene, t0: Any, delta: Any) -> Any:
    """Of a period that begins and ends with this deflection."""
    if not scene.vibrates:
        V = multiprecision(scene.V)
        if solution.is_open(scene, t0):
            return solution.force(scene, t0, 0)
        # nothing moves the bristle: no damping
        drive, now = Drive(scene, t0, EXTENDED), REAL(0)
        bristle = drive.sigma(now) * REAL(delta)
        if scene.friction == "Coulomb":
            bristle = drive.coulomb(now) * np.sign(scene.V)
        return multiprecision(bristle) + MP.mpf(scene.sigma_2) * V
    step = solution.advance(scene, t0, scene.period, delta)
    # a period of the damping gives back what rounding leaves
    rest = MP.mpf(scene.sigma_1) * (multiprecision(step.delta) - multiprecision(delta))
    return (multiprecision(step.impulse) - rest * (scene.friction != "Coulomb")) / scene.period


def _cycle(scene: Scene, t0: Any, delta: Any, slips: int) -> Settled:
    """A period that sticks shifts the deflection by V T; one that slips along a bound forgets its start.

    A drop that sticks at once forgets nothing: there may be no cycle (ArithmeticError).
    """
    shift, seen = REAL(multiprecision(scene.V) * scene.period), []
    while len(seen) < MOST_SLIPS:
        impulse, periods = REAL(0), 0
        if not slips:
            impulse, periods = _stuck_periods(scene, t0, delta, shift)
            delta = delta + periods * shift
            if periods == LONGEST_STICK or (periods and shift == 0):
                return Settled(delta, 0, impulse / periods * REAL(scene.f))
        step = stop.advance(scene, t0, scene.period, delta, slips)
        delta, slips = step.delta, step.slips
        seen.append((delta, slips, impulse + step.impulse, periods + 1))
        for k, (earlier, side, *_) in enumerate(seen[:-1]):
            if side == slips and abs(earlier - delta) <= 1e-15 * (abs(delta) + abs(shift)):
                cycle = seen[k + 1 :]
                total, count = sum(one[2] for one in cycle), sum(one[3] for one in cycle)
                delta, slips, *_ = min(cycle, key=lambda one: abs(one[0]))
                return Settled(delta, slips, total / count * REAL(scene.f))
    raise ArithmeticError("no cycle found")


def _stuck_periods(scene: Scene, t0: Any, delta: Any, shift: Any) -> tuple[Any, int]:
    """Impulse [N s] and number of the periods before one slips."""

    def period(k: int) -> stop.Reached:
        return stop.advance(scene, t0, scene.period, delta + k * shift)

    first = period(0)
    if first.has_slipped:
        return REAL(0), 0
    if shift == 0:
        return first.impulse, 1
    sticks, slips = 0, 1
    while slips < LONGEST_STICK and not period(slips).has_slipped:
        sticks, slips = slips, 2 * slips
    while slips - sticks > 1:
        middle = (sticks + slips) // 2
        sticks, slips = (sticks, middle) if period(middle).has_slipped else (middle, slips)
    # the impulse of a period that sticks is affine in its start
    return slips * (first.impulse + period(slips - 1).impulse) / 2, slips


def _without_the_bound(scene: Scene, t0: Any, delta_0: Any) -> Any:
    """The same of a bristle that no bound holds; a drift of ElasticPlastic leads to one."""
    if scene.V == 0 and (scene.V_1 == 0 or scene.friction == "ElasticPlastic"):
        return delta_0
    if scene.vibrates and scene.friction != "ElasticPlastic":
        period = interval_map(scene, t0, scene.period, EXTENDED)
        return period.offset / period.relaxation
    drive, zero = Drive(scene, t0, EXTENDED), REAL(0)
    return np.sign(scene.V) * drive.limit(zero) / drive.sigma(zero)
