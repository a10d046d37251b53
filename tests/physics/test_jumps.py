"""Inputs and parameters that jump between two steps: what the bristle and the heat do, by the reference."""

from __future__ import annotations

from itertools import count, islice

import numpy as np
import pytest
from model_exchange.exchange_scenes import drawn

from frictioncontact.fmu import FrictionFmu
from workshop.reference import FIELDS, INPUTS, after, changed, rest, start_values, step

GRADED = ("F_t", "F_y", "W_f", "Q_f")
ALLOWED = 1e-6  # of the largest force, and of that times the path; the tolerance is 1e-8


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
def test_a_bound_that_jumps_below_the_bristle(fmu: FrictionFmu, planar: bool) -> None:
    """Where it has stuck, with static friction in some scenes, and d, E and V jump with it."""
    bounded = (each for each in (drawn(k, planar) for k in count()) if each.law == 3 or each.limit == 2)
    jumped = 0
    for number, scene in enumerate(islice(bounded, 24)):
        rng = np.random.default_rng([37, number])
        held = changed(scene, h=1e-9, **{f"{name}_rate": 0.0 for name in INPUTS})
        limit, sigma = rest(held)
        size = rng.uniform(0.8, 1.0) * limit * held.staticRatio / sigma
        first = changed(held, delta_0=size * (0.8 if planar else 1.0), delta_y_0=size * 0.6 * planar)
        falls = {name: getattr(first, name) * rng.uniform(0.4, 0.9) for name in ("load", "F_C", "mu")}
        moves = {"V": -0.7 * first.V, "d": 1.02 * first.d, "E": 0.9 * first.E} if number % 2 else {}
        truth = step(first)
        left, then = after(first, truth, **falls, **moves, h=scene.h)
        end = step(then, left)
        with fmu.session(start_values(first) | {"solver.tolerance": 1e-8}) as session:
            session.step(first.h)
            for name in (*falls, *moves):
                session.set(FIELDS[name], getattr(then, name))
            session.step(then.h)
            found = dict(zip(GRADED, session.read(GRADED), strict=True))
        S, path = max(truth.S, end.S), truth.path + end.path
        for name in ("F_t", "F_y"):
            assert abs(found[name] - getattr(end, name)) < ALLOWED * S, (number, name)
        for name in ("W_f", "Q_f"):
            right = getattr(truth, name) + getattr(end, name)
            assert abs(found[name] - right) < ALLOWED * S * path, (number, name)
        jumped += step(changed(then, h=1e-30), left).Q_f > 100 * ALLOWED * S * path
    assert jumped > 12
