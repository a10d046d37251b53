"""What a solver is graded against: Eq. 1-4, 12-14, 20-22 and 24 from the formulas, independent of the C code.

`solve` is the quadrature of `quadrature`, by default in extended precision: 1e-17 in 0.1 s a
period, where 40 digits take 10 s. `collocation` and `constant` solve the same scenes by
other means and in 40 digits; the tests hold them all together.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from frictionlab.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, Arithmetic, multiprecision
from frictionlab.reference.contact import Contact, area, stiffness
from frictionlab.reference.mesh import graded_mesh
from frictionlab.reference.quadrature import AffineMap, interval_map
from frictionlab.reference.scene import Drive, Scene, events

# Where long double is no wider than double, 40 digits must do.
DEFAULT = EXTENDED if np.finfo(np.longdouble).nmant >= 63 else MULTIPRECISION

__all__ = [
    "EXTENDED",
    "MP",
    "MULTIPRECISION",
    "Contact",
    "Drive",
    "Scene",
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
    if scene.friction == "Coulomb":
        return MP.mpf(scene.F_C) * MP.sign(Drive(scene, t, MULTIPRECISION).V(MP.mpf(0)))
    return sigma(scene, t) * multiprecision(delta)


def solve(
    scene: Scene, t0: Any, t1: Any, delta_0: Any, arithmetic: Arithmetic = DEFAULT
) -> tuple[Any, Any, Any]:
    """Deflection [m] at t1, impulse [N s] and work [J] over [t0, t1] (absolute times, s)."""
    h = MP.mpf(t1) - MP.mpf(t0)
    if scene.friction == "Coulomb":
        return _coulomb(scene, t0, h)
    return _map(scene, t0, h, arithmetic).apply(arithmetic.real(delta_0))


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


def _coulomb(scene: Scene, t0: Any, h: Any) -> tuple[Any, Any, Any]:
    drive = Drive(scene, t0, MULTIPRECISION)
    F_C = MP.mpf(scene.F_C)
    corners = [MP.mpf(0), *events(drive, h), h]
    impulse, path = MP.mpf(0), MP.mpf(0)
    for left, right in zip(corners[:-1], corners[1:], strict=True):
        sign = MP.sign(drive.V((left + right) / 2))
        impulse += F_C * sign * (right - left)
        swing = MP.mpf(0)
        if drive.V_1 != 0:
            swing = drive.V_1 * (MP.sin(drive.theta(right)) - MP.sin(drive.theta(left))) / drive.omega
        path += sign * (drive.V_0 * (right - left) + drive.V_rate * (right**2 - left**2) / 2 + swing)
    return MP.mpf(0), impulse, F_C * path


def periodic_deflection(scene: Scene, t0: Any = 0, arithmetic: Arithmetic = DEFAULT) -> Any:
    """The deflection [m] at t0 that one period of held inputs brings back."""
    period = _map(scene, t0, scene.period, arithmetic)
    return period.offset / period.relaxation


def periodic_mean(scene: Scene, arithmetic: Arithmetic = DEFAULT) -> Any:
    """Time mean of F_t [N] over one period of the periodic state."""
    if scene.friction == "Coulomb":
        return _coulomb(scene, 0, scene.period)[1] / scene.period
    delta = periodic_deflection(scene, 0, arithmetic)
    _, impulse, _ = _map(scene, 0, scene.period, arithmetic).apply(delta)
    return impulse * arithmetic.real(scene.f)
