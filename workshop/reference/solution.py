"""What a solver is graded against: Eq. 1-4, 12-14, 20-22 and 24 from the formulas, independent of the C code.

`solve` is the quadrature of `quadrature`, by default in extended precision: 1e-17 in 0.1 s a
period, where 40 digits take 10 s. `collocation` and `constant` solve the same scenes by
other means and in 40 digits; the tests hold them all together.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from workshop.reference import stop
from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, Arithmetic, multiprecision
from workshop.reference.contact import Contact, area, stiffness
from workshop.reference.coulomb import coulomb
from workshop.reference.mesh import graded_mesh
from workshop.reference.quadrature import AffineMap, interval_map
from workshop.reference.scene import Drive, Scene, events

# Where long double is no wider than double, 40 digits must do.
DEFAULT = EXTENDED if np.finfo(np.longdouble).nmant >= 63 else MULTIPRECISION

__all__ = [
    "EXTENDED",
    "MP",
    "MULTIPRECISION",
    "Contact",
    "Drive",
    "Scene",
    "StepResult",
    "advance",
    "area",
    "events",
    "force",
    "graded_mesh",
    "periodic_deflection",
    "periodic_mean",
    "sigma",
    "solve",
    "stiffness",
]


def sigma(scene: Scene, t: Any) -> Any:
    """Stiffness [N/m] at the absolute time t [s]."""
    return Drive(scene, t, MULTIPRECISION).sigma(MP.mpf(0))


def force(scene: Scene, t: Any, delta: Any) -> Any:
    """F_t [N] at the absolute time t [s] and deflection delta [m]."""
    drive, now = Drive(scene, t, MULTIPRECISION), MP.mpf(0)
    V, delta = drive.V(now), multiprecision(delta)
    if scene.friction == "Coulomb":
        return drive.coulomb(now) * MP.sign(V) + drive.sigma_2 * V
    rate = stop.rate(scene, t, delta) if scene.bounded else V - drive.relaxation_rate(now) * delta
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


def advance(scene: Scene, t0: Any, h: Any, delta_0: Any, arithmetic: Arithmetic = DEFAULT) -> StepResult:
    """One communication step from the absolute time t0 [s] over h [s], every law."""
    if scene.friction == "Coulomb":
        return StepResult(*coulomb(scene, t0, h, delta_0))
    if scene.bounded:
        return StepResult(*stop.advance(scene, t0, h, delta_0))
    return StepResult(*_map(scene, t0, MP.mpf(h), arithmetic).apply(arithmetic.real(delta_0)))


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
