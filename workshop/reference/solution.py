"""What a solver is graded against: Eq. 1-4, 12-14, 20-22 and 24 from the formulas, independent of the C code.

`solve` is the quadrature of `quadrature`, by default in extended precision: 1e-17 in 0.1 s a
period, where 40 digits take 10 s.
"""

from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from workshop.reference import stop
from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, Arithmetic, multiprecision
from workshop.reference.coulomb import coulomb, without_contact
from workshop.reference.quadrature import AffineMap, interval_map
from workshop.reference.scene import Drive, Scene

# Where long double is no wider than double, 40 digits must do.
DEFAULT = EXTENDED if np.finfo(np.longdouble).nmant >= 63 else MULTIPRECISION


def sigma(scene: Scene, t: Any) -> Any:
    """Stiffness [N/m] at the absolute time t [s]."""
    return Drive(scene, t, MULTIPRECISION).sigma(MP.mpf(0))


def force(scene: Scene, t: Any, delta: Any, slips: int = 0) -> Any:
    """F_t [N] at the absolute time t [s] and deflection delta [m]; slips as in StepResult."""
    drive, now = Drive(scene, t, MULTIPRECISION), MP.mpf(0)
    V, delta = drive.V(now), multiprecision(delta)
    if is_open(scene, t):
        return sliding_when_open(scene) * MP.sign(V) + drive.sigma_2 * V
    if scene.friction == "Coulomb":
        return drive.coulomb(now) * MP.sign(V) + drive.sigma_2 * V
    rate = stop.rate(scene, t, delta, slips) if scene.bounded else V - drive.relaxation_rate(now) * delta
    return drive.sigma(now) * delta + drive.sigma_1 * rate + drive.sigma_2 * V


def solve(
    scene: Scene, t0: Any, t1: Any, delta_0: Any, arithmetic: Arithmetic = DEFAULT
) -> tuple[Any, Any, Any]:
    """Deflection [m] at t1, impulse [N s] and work [J] over [t0, t1] (absolute times, s)."""
    return advance(scene, t0, MP.mpf(t1) - MP.mpf(t0), delta_0, arithmetic)[:3]


class StepResult(NamedTuple):
    delta: Any  # m, at the end
    impulse: Any  # N s, integral of F_t
    work: Any  # J
    heat: Any  # J
    slips: int = 0  # the side it slips to where break-away is a drop; 0: it sticks


def advance(
    scene: Scene, t0: Any, h: Any, delta_0: Any, arithmetic: Arithmetic = DEFAULT, slips: int = 0
) -> StepResult:
    """One communication step from the absolute time t0 [s] over h [s], every law.

    A bounded bristle that starts beyond its bound gets onto it first: `stop.project`.
    """
    t0, delta, sums = MP.mpf(t0), delta_0, np.zeros(3, dtype=object)
    for begin, end, opened in parts(scene, t0, MP.mpf(h)):
        if opened:
            sliding = without_contact(scene, sliding_when_open(scene))
            part = StepResult(0, *coulomb(sliding, t0 + begin, end - begin, 0)[1:])
        else:
            part = _closed(scene, t0 + begin, end - begin, delta, arithmetic, slips)
        delta, *integrals, slips = part
        if not opened and end < h:  # it opens
            delta, slips, lost = 0, 0, stored_when_opening(scene, t0 + end, delta)
            integrals[2] = integrals[2] + lost
        sums = sums + np.array(integrals, dtype=object)
    return StepResult(delta, *sums, slips)


def _closed(scene: Scene, t0: Any, h: Any, delta_0: Any, arithmetic: Arithmetic, slips: int) -> StepResult:
    if scene.friction == "Coulomb":
        return StepResult(*coulomb(scene, t0, h, delta_0))
    if not scene.bounded:
        return StepResult(*_map(scene, t0, h, arithmetic).apply(arithmetic.real(delta_0)))
    before = stop.project(scene, t0, delta_0)
    if slips:
        before = delta_0, slips, 0
    step = stop.advance(scene, t0, h, *before[:2])
    return StepResult(step.delta, step.impulse, step.work, step.heat + before[2], step.slips)


def is_open(scene: Scene, t: Any) -> bool:
    """Whether the contact is open at the time t and has no bristle."""
    if not scene.needs_load:
        return False
    lead = MP.mpf(t) - MP.mpf(scene.start)
    if scene.input == "Load":
        return scene.load + lead * MP.mpf(scene.load_rate) <= 0
    rest = Drive(replace(scene, a_d=0.0), t, MULTIPRECISION)
    return min(rest.normal_force(MP.mpf(0)), rest.sigma(MP.mpf(0))) < MP.mpf("1e-100")


def sliding_when_open(scene: Scene) -> float:
    """The limit [N] of an open contact: Coulomb's that is constant does not know the load."""
    return scene.F_C if scene.friction == "Coulomb" and scene.limit == "Constant" else 0.0


def stored_when_opening(scene: Scene, t: Any, delta: Any) -> Any:
    """The heat [J] of an opening: what a constant stiffness stores, as its bound falls to 0; else nothing."""
    loses = scene.contact.model == "Constant" and scene.limit == "Load" and scene.friction != "Coulomb"
    return sigma(scene, t) * multiprecision(delta) ** 2 / 2 if loses else MP.mpf(0)


# of the step's largest load: below, what the contact does counts with its square
LEAST_LOAD = MP.mpf("1e-9")


def parts(scene: Scene, t0: Any, h: Any) -> list[tuple[Any, Any, bool]]:
    """Local times of begin and end of the parts of a step, and whether the contact is open there."""
    if not (scene.needs_load and scene.input == "Load" and scene.load_rate):
        return [(MP.mpf(0), h, is_open(scene, t0))]
    drive = Drive(scene, t0, MULTIPRECISION)
    first, last = drive.load(MP.mpf(0)), drive.load(h)
    if (first > 0 and last > 0) or (first <= 0 and last <= 0):
        return [(MP.mpf(0), h, first <= 0)]
    zero = (LEAST_LOAD * max(first, last) - first) / drive.load_rate
    return [(MP.mpf(0), zero, first <= 0), (zero, h, last <= 0)]


@lru_cache(maxsize=512)
def _map(scene: Scene, t0: Any, h: Any, arithmetic: Arithmetic) -> AffineMap:
    periods = int(MP.floor(h * scene.f)) if scene.vibrates and scene.held else 0
    if periods < 2:
        return interval_map(scene, t0, h, arithmetic)
    whole = interval_map(scene, t0, scene.period, arithmetic).power(periods)
    rest = h - periods * scene.period
    if rest <= 0:
        return whole
    return whole.then(interval_map(scene, t0, rest, arithmetic))


def periodic_deflection(scene: Scene, t0: Any = 0, arithmetic: Arithmetic = DEFAULT) -> Any:
    """The deflection [m] at t0 that one period of held inputs brings back."""
    period = _map(scene, t0, scene.period, arithmetic)
    return period.offset / period.relaxation


def periodic_mean(scene: Scene, arithmetic: Arithmetic = DEFAULT) -> Any:
    """Time mean of F_t [N] over one period of the periodic state."""
    if scene.friction == "Coulomb":
        return coulomb(scene, 0, scene.period, 0)[1] / scene.period
    delta = periodic_deflection(scene, 0, arithmetic)
    _, impulse, _, _ = _map(scene, 0, scene.period, arithmetic).apply(delta)
    return impulse * arithmetic.real(scene.f)
