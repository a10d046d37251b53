"""CasADi's importer of model exchange: it takes rates and directional derivatives, and knows no events."""

from __future__ import annotations

from itertools import count, islice

import casadi
import numpy as np
import pytest
from model_exchange.exchange_scenes import LARGEST, drawn, error, is_held

from frictioncontact.fmu import FrictionFmu, Value
from tools.reference import Scene, start_values

TOLERANCE = 1e-8
ALLOWED = 300 * TOLERANCE  # over all steps; CasADi asks for one tolerance of states of very different sizes


def without_bound(now: Scene) -> bool:
    """Dahl and LuGre with a constant limit, held inputs."""
    return now.law != 3 and now.limit == 1 and is_held(now)


def builder(fmu: FrictionFmu, start_values: dict[str, Value]) -> casadi.DaeBuilder:
    dae = casadi.DaeBuilder("contact", str(fmu.directory))
    for name, value in start_values.items():
        dae.set(name, fmu.known.number(name, value, name))
    return dae


def integrated(fmu: FrictionFmu, scene: Scene) -> dict[str, float]:
    """By CasADi's CVODES, in states of the size 1."""
    dae = builder(fmu, start_values(scene))
    contact = dae.create("contact", ["t", "x", "u"], ["ode", "y"])
    length = scene.F_C / scene.contact_sigma
    energy = scene.F_C * max(abs(scene.V), scene.V_1) * scene.h
    size_of = {"delta": length, "delta_y": length, "W_f": energy, "Q_f": energy}
    sizes = casadi.DM([size_of[name] for name in dae.x()])
    inputs = casadi.DM([getattr(scene, name, 0.0) for name in dae.u()])
    t, x = casadi.MX.sym("t"), casadi.MX.sym("x", len(dae.x()))
    rates, _ = contact(t, sizes * x, inputs)
    solver = casadi.integrator(
        "solver",
        "cvodes",
        {"t": t, "x": x, "ode": rates / sizes},
        0.0,
        scene.h,
        {"reltol": TOLERANCE, "abstol": TOLERANCE, "max_num_steps": 1_000_000},
    )
    start = casadi.DM([scene.delta_0 if name == "delta" else 0.0 for name in dae.x()])
    end = sizes * solver(x0=start / sizes)["xf"]
    _, outputs = contact(scene.h, end, inputs)
    found = dict(zip(dae.y(), np.array(outputs).ravel(), strict=True))
    return {name: found[name] for name in LARGEST}


def test_integration_without_events(fmu: FrictionFmu) -> None:
    """A kink of |V| that no event marks costs CVODES steps, and no accuracy."""
    for scene in islice(filter(without_bound, map(drawn, count())), 4):
        assert error(scene, integrated(fmu, scene)) < ALLOWED


def test_jacobians(fmu: FrictionFmu) -> None:
    """Exact ones, by time, states, inputs and parameters, and differences of CasADi's own evaluations."""
    start = {"friction.model": "LuGre", "friction.staticRatio": 1.4, "contact.stiffnessScale": 1e-4}
    start |= {"friction.sigma_1": 20.0, "friction.sigma_2": 30.0}
    start |= {"vibration.V_1": 0.5, "vibration.a_d": 1e-6, "vibration.V_2": 0.3}
    dae = builder(fmu, start)
    contact = dae.create("contact", ["t", "x", "u", "p"], ["ode"])
    values = {"V": 0.1, "d": 14e-6, "E": 58e9, "load": 312.0, "V_y": -0.07, "delta": 2e-8, "delta_y": 3e-8}
    x, u = (np.array([values.get(name, 1e-4) for name in names]) for names in (dae.x(), dae.u()))
    at = [np.array([3e-6]), x, u, np.array(dae.get(dae.p()))]
    blocks = [np.array(block) for block in contact.jacobian()(*at, 0)]
    for which, exact in enumerate(blocks):
        for k, value in enumerate(at[which]):
            size = abs(value) or 1.0  # a phase, or what counts for nothing
            step = 1e-6 * size * (np.arange(len(at[which])) == k)
            ends = [
                np.array(contact(*at[:which], at[which] + side * step, *at[which + 1 :])).ravel()
                for side in (1, -1)
            ]
            difference = (ends[0] - ends[1]) / (2 * step[k])
            scale = np.abs(ends[0]).max() / size
            assert exact[:, k] == pytest.approx(difference, rel=1e-6, abs=1e-7 * scale), (which, k)
