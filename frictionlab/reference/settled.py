"""Where the deflection tends after infinitely many periods of held inputs, or after sliding for ever."""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.reference import stop
from frictionlab.reference.arithmetic import EXTENDED
from frictionlab.reference.quadrature import interval_map
from frictionlab.reference.scene import Drive, Scene


def settled(scene: Scene, t0: Any, delta_0: Any) -> Any:
    """The limit of the deflection [m] at the phase of t0 [s]; delta_0 where nothing moves it."""
    if scene.friction == "Coulomb":
        return EXTENDED.real(delta_0)
    if scene.friction == "ElasticPlastic":
        return _settled_stop(scene, t0, delta_0)
    if not scene.vibrates:
        return _sliding(scene, t0) if scene.V != 0 else EXTENDED.real(delta_0)
    if scene.V == 0 and scene.V_1 == 0:
        return EXTENDED.real(delta_0)
    period = interval_map(scene, t0, scene.period, EXTENDED)
    return period.offset / period.relaxation


def _sliding(scene: Scene, t0: Any) -> Any:
    """sgn V g / sigma."""
    drive, zero = Drive(scene, t0, EXTENDED), EXTENDED.real(0)
    return np.sign(drive.V(zero)) * drive.limit(zero) / drive.sigma(zero)


def _settled_stop(scene: Scene, t0: Any, delta_0: Any) -> Any:
    """One period maps delta to clamp(delta + V T, low, high): a drift ends at the clamp it meets.

    The bounds themselves map to low and high, since from there V T leads outward or nowhere.
    """
    if not scene.vibrates:
        return _sliding(scene, t0) if scene.V != 0 else stop.project(scene, t0, delta_0)[0]
    drive, zero = Drive(scene, t0, EXTENDED), EXTENDED.real(0)
    bound = drive.limit(zero) / drive.sigma(zero)
    if scene.V != 0:
        return stop.advance(scene, t0, scene.period, np.sign(scene.V) * bound)[0]
    low, high = (stop.advance(scene, t0, scene.period, side * bound)[0] for side in (-1, 1))
    return min(max(EXTENDED.real(delta_0), low), high)
