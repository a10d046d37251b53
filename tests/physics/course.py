"""One contact from step to step, as a master moves it: inputs and parameters may jump between the steps.

A jump is the limit of a fast ramp. Along it the separation, E and V go linearly; other changes scale g and
sigma by powers. A bristle is moved where its bound comes to lie below it.
"""

from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from workshop.reference import solution, stop
from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, gauss_arrays, multiprecision
from workshop.reference.coulomb import path
from workshop.reference.jet import JETS, Jet, at
from workshop.reference.scene import Drive, Scene

REAL = EXTENDED.real


class Step(NamedTuple):
    F_t: Any  # N, at the end
    F_t_mean: Any  # N
    W_f: Any  # J, since the start
    Q_f: Any  # J, since the start
    delta: Any  # m
    scale: float  # N, what the tolerance is relative to
    path: float  # m, integral of |V| over the step


class Course:
    """Starts at the scene's start from delta_0 [m]; or from where it is told, when it has settled."""

    def __init__(self, scene: Scene, delta_0: float, slips: int = 0) -> None:
        self.before, self.t = None, MP.mpf(scene.start)
        self.delta, self.slips = EXTENDED.real(delta_0), slips
        self.work, self.heat = MP.mpf(0), MP.mpf(0)
        if solution.is_open(scene, scene.start):
            self.delta = REAL(0)
        elif scene.bounded and not slips:
            self.delta, self.slips, heat = stop.project(scene, scene.start, delta_0)
            self.heat += multiprecision(heat)
        self.begin = delta_0

    def step(self, scene: Scene, h: float) -> Step:
        """Over h [s] with these inputs; scene.start is not looked at."""
        scene, length = replace(scene, start=float(self.t)), MP.mpf(h)
        if self.before is not None:
            self.begin = self.delta
            self.delta, self.slips, heat = jump(self.before, scene, self.t, self.delta, self.slips)
            self.heat += multiprecision(heat)
        S = scale(scene, self.t, h, self.begin)
        done = solution.advance(scene, self.t, length, self.delta, slips=self.slips)
        self.before, self.t = scene, self.t + length
        self.delta, self.slips = done.delta, done.slips
        self.work += multiprecision(done.work)
        self.heat += multiprecision(done.heat)
        F_t = solution.force(scene, self.t, self.delta, self.slips)
        mean = multiprecision(done.impulse) / length
        way = float(path(replace(scene, start=float(self.t - length)), self.t - length, h))
        return Step(F_t, mean, self.work, self.heat, self.delta, S, way)


def scale(scene: Scene, t0: Any, h: float, delta: Any) -> float:
    """S [N] of a step: the largest of limit, the bristle's force at its start and what V causes by itself."""
    rest, now, end = Drive(replace(scene, a_d=0.0), t0, MULTIPRECISION), MP.mpf(0), MP.mpf(h)
    drive = Drive(scene, t0, MULTIPRECISION)
    speed = max(abs(drive.V_0), abs(drive.V_0 + drive.V_rate * end)) + drive.V_1
    sizes = [(drive.sigma_1 if scene.friction != "Coulomb" else 0) * speed + drive.sigma_2 * speed]
    for tau in (now, end):
        if scene.limit == "Constant":
            limit = MP.mpf(scene.F_C)
        elif scene.input == "Load":
            limit = MP.mpf(scene.mu) * max(drive.load(tau), 0)
        else:
            limit = MP.mpf(scene.mu) * rest.normal_force(tau) * drive.swell
        sizes.append(limit * (1 + drive.excess))
    if scene.friction != "Coulomb" and not solution.is_open(scene, t0):
        sizes.append(abs(drive.sigma(now) * multiprecision(delta)))
    return float(max(sizes))


def jump(before: Scene, after: Scene, t: Any, delta: Any, slips: int = 0) -> tuple[Any, int, Any]:
    """Deflection [m], the side it slips to and heat [J] of a jump at the time t from one scene to another."""
    closed = not solution.is_open(before, t), not solution.is_open(after, t)
    if closed == (True, False):
        return REAL(0), 0, solution.stored_when_opening(before, t, delta)
    if not all(closed):
        return REAL(0), 0, REAL(0)
    if not after.bounded:
        return delta, slips, REAL(0)
    return _Ramp(before, after, t).follow(REAL(delta), slips)


class _Ramp:
    """The way between two scenes, over s from 0 to 1."""

    def __init__(self, before: Scene, after: Scene, t: Any) -> None:
        self.after, self.t = after, t
        ends, now = (Drive(before, t, MULTIPRECISION), Drive(after, t, MULTIPRECISION)), MP.mpf(0)
        self.V, self.d, self.E = ([REAL(getattr(end, name)(now)) for end in ends] for name in ("V", "d", "E"))
        plain = {"a_d": 0.0, "V_1": 0.0, "input": "Separation", "E": float(min(self.E))}
        self.drives = [Drive(replace(scene, **plain), t, JETS) for scene in (before, after)]
        # parameters scale by powers: at both scenes' ends with the separation and E of after
        for drive in self.drives:
            for name, (begin, end) in (("V", self.V), ("d", self.d), ("E", self.E)):
                setattr(drive, f"{name}_0", begin)
                setattr(drive, f"{name}_rate", end - begin)
            drive._held.clear()

    def _power(self, name: str, s: Jet) -> Jet:
        one, other = (getattr(drive, name)(s) for drive in self.drives)
        other = other / one
        return one * JETS.exp(s * JETS.log(other)) if np.any(other.value != 1) else one

    def bound(self, s: Any, *, static: bool = False) -> Jet:
        """D [m], the kinetic one unless static is asked for."""
        s = s if isinstance(s, Jet) else at(s)
        drive, g = self.drives[1], self._power("coulomb", s)
        curve = drive.curve(s) if self.after.friction == "ElasticPlastic" and not static else 1 + drive.excess
        return g * curve / self._power("sigma", s)

    def follow(self, delta: Any, slips: int, begin: Any = 0) -> tuple[Any, int, Any]:
        """Deflection [m], the side it slips to and heat [J] at the end, from there on."""
        side, size, heat, begin = int(np.sign(delta)), abs(delta), REAL(0), REAL(begin)
        if side == 0:
            return delta, slips, heat
        if begin == 0 and self.drives[0].excess == 0 and side * self.V[0] > 0:
            slips = side if size >= self.bound(begin).value * (1 - 1e-10) else 0
        if self.after.drops and slips == 0:
            meets = [low for low, _ in self._falls(size, begin, static=True)]
            if not meets:
                return delta, 0, heat
            begin, slips = meets[0], side
            kinetic = min(self.bound(begin).value, size)
            sigma = self._power("sigma", at(begin)).value
            heat += sigma * (size - kinetic) * (size + kinetic) / 2
            size = kinetic
        elif self.after.drops:
            low, high = (self.bound(REAL(place)).value for place in (0, 1))
            if side * self.V[0] <= 0 and abs(high - low) <= 1e-10 * low:
                return delta, slips, heat  # nothing but rounding
            # behind a bound that rises again it sticks
            if size < low * (1 - 1e-10) and high > low * (1 + 1e-10):
                return self.follow(delta, 0)
        released = self._released(side, begin)
        rule = gauss_arrays(EXTENDED.nodes, EXTENDED)
        for low, high in self._falls(size, begin):
            if low > released + 1e-12:
                break
            edges = low + (high - low) * np.arange(65, dtype=np.longdouble) / 64
            length = np.diff(edges)[:, None]
            s = at(edges[:-1, None] + length * rule.nodes)
            D = self.bound(s)
            heat -= (length * rule.weights * self._power("sigma", s).value * D.value * D.first).sum()
            size = self.bound(high).value
            released = max(released, high)
        if self.after.drops and released < 1:
            delta, slips, more = self.follow(side * size, 0, released)
            return delta, slips, heat + more
        return side * size, slips if self.after.drops else 0, heat

    def _released(self, side: int, begin: Any) -> Any:
        """The place from which nothing pushes a bristle that has broken away: it sticks unless it slips."""
        drive = Drive(self.after, self.t, JETS)
        now = at(REAL(0))
        if not self.after.drops or side * drive.V(now).value > drive.bound(now).first:
            return REAL(1)
        first, last = (side * V for V in self.V)
        if min(first, last) > 0:
            return REAL(1)
        return max(begin, first / (first - last)) if first > 0 else begin

    def _falls(self, size: Any, begin: Any = 0, *, static: bool = False) -> list[tuple[Any, Any]]:
        """Where the bound is below all it was, and below size: from, to."""

        def value(s: Any) -> Any:
            return self.bound(s, static=static).value

        grid = REAL(begin) + (1 - REAL(begin)) * np.arange(1025, dtype=np.longdouble) / 1024
        turns = stop._zeros(lambda s: self.bound(s, static=static).first, grid, 60)
        found = []
        for low, high in pairwise([REAL(begin), *turns, REAL(1)]):
            if value(high) < size:
                if value(low) > size:
                    low = stop._crossing(lambda s, most=size: most - value(s), low, high)
                found.append((low, high))
                size = value(high)
        return found
