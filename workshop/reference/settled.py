"""Where the deflection tends after infinitely many periods of held inputs, or after sliding for ever."""

from __future__ import annotations

from typing import Any

import numpy as np

from workshop.reference import stop
from workshop.reference.arithmetic import EXTENDED
from workshop.reference.quadrature import interval_map
from workshop.reference.scene import Drive, Scene


def settled(scene: Scene, t0: Any, delta_0: Any) -> Any:
    """The limit of the deflection [m] at the phase of t0 [s]; delta_0 where nothing moves it."""
    if scene.friction == "Coulomb":
        return EXTENDED.real(delta_0)
    tends_to = _without_the_bound(scene, t0, EXTENDED.real(delta_0))
    if not scene.bounded:
        return tends_to
    if not scene.vibrates:
        return stop.project(scene, t0, tends_to)[0]
    # a period is a clamped affine map: its fixed point is where it takes that of the affine map
    return stop.advance(scene, t0, scene.period, tends_to)[0]


def _without_the_bound(scene: Scene, t0: Any, delta_0: Any) -> Any:
    """The same of a bristle that no bound holds; a drift of ElasticPlastic leads to one."""
    if scene.V == 0 and (scene.V_1 == 0 or scene.friction == "ElasticPlastic"):
        return delta_0
    if scene.vibrates and scene.friction != "ElasticPlastic":
        period = interval_map(scene, t0, scene.period, EXTENDED)
        return period.offset / period.relaxation
    drive, zero = Drive(scene, t0, EXTENDED), EXTENDED.real(0)
    return np.sign(scene.V) * drive.limit(zero) / drive.sigma(zero)
