"""The default method errs by the tolerance at most: every law and limit, along a line and in the plane.

Against hunt/reference.c. Errors are relative to S, the largest force of the step, and to S times the path, as
docs/numerics.md promises.
"""

from __future__ import annotations

import cmath
import math
import random
from typing import Any

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu
from tools.reference import CHOICES, FIELDS, INPUTS, Scene, rest, scene, start_values, step

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8)
ROUNDING = 1e-11
F = 20e3  # Hz
GRADED = ("F_t", "F_y", "F_t_mean", "F_y_mean", "W_f", "Q_f")
Results = dict[str, float]


def results(fmu: FrictionFmu, now: Scene, tolerance: float, method: str = "collocation") -> Results:
    solver = {"solver.tolerance": tolerance, "solver.method": method}
    with fmu.session(start_values(now) | solver, now.start) as session:
        session.set_rates(**{FIELDS[name]: getattr(now, f"{name}_rate") for name in INPUTS})
        session.step(now.h)
        names = (*GRADED, "solver.evaluations")
        return dict(zip(names, session.read(names), strict=True))


def error(now: Scene, found: Results, truth: Any) -> float:
    """The largest one, over S or S times the path. Rounding of the deflection counts to the path."""
    moved = math.hypot(truth.delta - now.delta_0, truth.delta_y - now.delta_y_0)
    size = math.hypot(truth.delta, truth.delta_y) + math.hypot(now.delta_0, now.delta_y_0)
    of_energy = truth.S * (truth.path + moved)
    rounding = (1e-13 + 20 * np.finfo(float).eps * now.h * now.f) * size * truth.S
    errors = []
    for name in GRADED:
        apart = abs(found[name] - getattr(truth, name))
        is_energy = name in ("W_f", "Q_f")
        errors.append(max(0.0, apart - rounding) / of_energy if is_energy else apart / truth.S)
    return max(errors)


# ---- the sweep ----


def drawn(
    rng: random.Random, law: str, limit: str, planar: bool, kappa: tuple[float, float] = (-3, 8)
) -> Scene:
    """kappa of 1e-3 to 1e8, any contact, V and the inputs held or linear, near a reversal and far from it."""
    V_1, f = 10 ** rng.uniform(-2, 0.5), 10 ** rng.uniform(2, 4.7)
    contact = rng.choice(CHOICES["contact"])
    nearly = V_1 * rng.choice((-1, 1)) * (1 + rng.choice((-1, 1)) * 10 ** rng.uniform(-8, -1))
    now = scene(
        law=law,
        limit=limit,
        contact=contact,
        V_1=V_1,
        V=rng.choice((V_1 * rng.uniform(-2, 2), nearly, rng.choice((0.0, 1e-300, -1e-9)))),
        f=f,
        h=rng.uniform(0.02, 2.5) / f,
        start=rng.random() / f,
        a_d=rng.choice((0.0, 1e-300, 1e-18, 10 ** rng.uniform(-8, -6))),
        phase_d=rng.uniform(-3, 3),
        F_C=10 ** rng.uniform(0, 2),
        input=rng.choice(CHOICES["input"]),
    )
    if rng.random() < 0.4:
        now.V_rate, now.d_rate = rng.uniform(-2, 2) * V_1 / now.h, rng.uniform(-5e-7, 5e-7) / now.h
        now.load_rate, now.E_rate = (rng.uniform(-0.5, 0.5) * x / now.h for x in (now.load, now.E))
    if planar:
        now.V_y = V_1 * rng.choice((-1, 1)) * 10 ** rng.uniform(-12, 0)
        now.V_2, now.phase_2 = rng.choice((0.0, V_1 * rng.random())), rng.uniform(-3, 3)
    if law in ("LuGre", "ElasticPlastic"):
        # Break-away that sticks at once multiplies errors if V_S is small beside the way over the bound.
        now.staticRatio, now.V_S = rng.choice((1.0, rng.uniform(1, 2))), V_1 * 10 ** rng.uniform(-1, 1)
    if law != "Coulomb":
        now.sigma_1 = rng.choice((0.0, 0.2 * now.F_C / V_1))
    now.sigma_2 = rng.choice((0.0, 0.2 * now.F_C / V_1))
    limit_0, sigma_0 = rest(now)
    stiffness = 10 ** rng.uniform(*kappa) * 2 * math.pi * f * limit_0 / V_1
    now.contact_sigma, now.stiffnessScale = stiffness, now.stiffnessScale * stiffness / sigma_0
    if law != "Coulomb":
        angle, size = rng.uniform(-3, 3) if planar else 0.0, rng.uniform(-0.9, 0.9) * limit_0 / stiffness
        now.delta_0, now.delta_y_0 = size * math.cos(angle), size * math.sin(angle)
    return now


def misses(fmu: FrictionFmu, now: Scene, what: object) -> list[str]:
    """The tolerances that a step from the scene misses, a line each."""
    truth = step(now)
    errors = {tolerance: error(now, results(fmu, now, tolerance), truth) for tolerance in TOLERANCES}
    return [f"{off:.2e} at {t:g}: {what}" for t, off in errors.items() if not off <= t + ROUNDING]


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
@pytest.mark.parametrize("limit", CHOICES["limit"])
@pytest.mark.parametrize("law", CHOICES["law"])
def test_sweep(fmu: FrictionFmu, law: str, limit: str, planar: bool) -> None:
    rng = random.Random(f"{law} {limit} {planar}")
    missed: list[str] = []
    for _ in range(40):
        now = drawn(rng, law, limit, planar)
        missed += misses(fmu, now, start_values(now))
    assert not missed, "\n".join(missed)


# ---- where V nearly touches 0 ----

AWAY = (0.02, 1e-3, 1e-8, -1e-8, -1e-2)  # 1 - |V / V_1|
PHASES = (0.0, 0.13, 0.5 + 1e-9)  # of the step's start, in periods
ANGLES = (0.0, 0.3, math.pi / 2, 4.1)  # of the sliding in the plane
ACROSS = (0.0, 1e-9)  # m/s


def near_zero(law: str, V: float, phase: float) -> Scene:
    made = scene(law=law, contact="Constant", V_1=1.0, V=V, F_C=8.5, f=F, contact_sigma=1.6e7)
    made.start, made.h = phase / F, 1 / F
    if law in ("LuGre", "ElasticPlastic"):
        made.staticRatio, made.V_S = 1.3, 0.1
    return made


def turned(now: Scene, angle: float, V_y: float) -> Scene:
    """The same motion in that direction, and V_y across it."""
    x, y = math.cos(angle), math.sin(angle)
    made = Scene.from_buffer_copy(now)
    made.V, made.V_y = now.V * x - V_y * y, now.V * y + V_y * x
    made.V_1, made.V_2, made.phase_2 = now.V_1 * abs(x), now.V_1 * abs(y), 0.0 if x * y >= 0 else math.pi
    if x < 0:  # amplitudes are not negative: half a period later
        made.start += 0.5 / now.f
    return made


def turned_back(found: Results, angle: float) -> Results:
    back = dict(found)
    for along, across in (("F_t", "F_y"), ("F_t_mean", "F_y_mean")):
        force = complex(found[along], found[across]) * cmath.exp(-1j * angle)
        back[along], back[across] = force.real, force.imag
    return back


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("law", CHOICES["law"])
def test_a_near_zero_of_any_direction(fmu: FrictionFmu, law: str, side: int) -> None:
    """V passes 0 twice around an extremum of the vibration, exactly or with V_y = 1e-9 m/s across."""
    missed = []
    for away in AWAY:
        for phase in PHASES:
            now = near_zero(law, side * (1 - away), phase)
            for V_y in (sign * V for V in ACROSS for sign in (-1, 1)):
                truth = step(turned(now, 0.0, V_y))
                for angle in ANGLES:
                    found = results(fmu, turned(now, angle, V_y), 1e-6)
                    off = error(now, turned_back(found, angle), truth)
                    if not off <= 1e-6 + ROUNDING:
                        missed.append(f"{off:.2e}: V {now.V}, V_y {V_y}, turned {angle}, phase {phase}")
    assert not missed, "\n".join(missed)


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
@pytest.mark.parametrize("law", CHOICES["law"])
def test_velocities_near_the_amplitude(fmu: FrictionFmu, law: str, planar: bool) -> None:
    """|V| = (1 +- 1e-1 .. 1e-12) V_1: two reversals that come near to each other, touch, and are a dip."""
    missed: list[str] = []
    for k, stiffness in ((k, sigma) for k in range(1, 13, 2) for sigma in (1e4, 1e7, 1e10)):
        for V in (side * (1 + way * 10.0**-k) for side in (-1, 1) for way in (-1, 1)):
            now = near_zero(law, V, 0.1 + 0.07 * k)
            now.contact_sigma, now.h = stiffness, 0.93 / F
            if planar:
                now.V_2, now.V_y, now.phase_2 = 0.5, -0.5 * math.copysign(1, V) * (1 - 10.0**-k), 0.0
            missed += misses(fmu, now, f"V {V!r}, sigma {stiffness:g}")
    assert not missed, "\n".join(missed)


# ---- the order ----


@pytest.mark.parametrize(("kappa", "V"), [(3.0, 2.0), (1e5, 0.3)], ids=["soft", "stiff"])
def test_order(fmu: FrictionFmu, kappa: float, V: float) -> None:
    """Errors fall at least with the power 17 of the evaluations: the order of Radau IIA of nine stages."""
    evaluations, errors = np.zeros(len(TOLERANCES)), np.zeros(len(TOLERANCES))
    for phase in np.arange(12) / 12:
        now = scene(law="Dahl", contact="Constant", V_1=0.9, V=V, f=F, start=phase / F, h=1.9 / F)
        now.contact_sigma = kappa * 2 * math.pi * F * now.F_C / now.V_1
        truth = step(now)
        for k, tolerance in enumerate(TOLERANCES):
            found = results(fmu, now, tolerance)
            evaluations[k] += found["solver.evaluations"]
            errors[k] += abs(found["F_t_mean"] - truth.F_t_mean) / truth.S
    order = -np.polyfit(np.log(evaluations), np.log(errors), 1)[0]
    assert order > 14
