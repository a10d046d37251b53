"""What holds for every scene: the cycle identity, a step in parts, a later start.

Values come from wide logarithmic ranges and from their ends: nothing moves, hardly anything moves,
contacts from softer to stiffer than any real one.
"""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from frictioncontact.fmu import OUTPUTS, FrictionFmu

TOLERANCE = 1e-8
# A power of two: its period, and any number of them, are exact in time.
FREQUENCY = 16384.0
PERIOD = 1.0 / FREQUENCY

every_scene = settings(
    max_examples=25,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def logarithmic(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(math.log10(low), math.log10(high)).map(lambda x: 10.0**x)


def signed(values: st.SearchStrategy[float]) -> st.SearchStrategy[float]:
    return st.tuples(values, st.sampled_from([-1.0, 1.0])).map(lambda pair: pair[0] * pair[1])


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, float | str]:
    """FMU start values."""
    V_1 = draw(st.just(0.0) | logarithmic(1e-9, 1e2))
    near = signed(st.sampled_from([1.0, 1.0 - 1e-9, 1.0 + 1e-9, 1.0 - 1e-3]).map(lambda x: x * V_1))
    V = draw(st.sampled_from([0.0, 1e-300, -1e-300]) | signed(logarithmic(1e-9, 1e2)) | near)
    d = draw(st.floats(8e-6, 20e-6))
    a_d = draw(st.sampled_from([0.0, 1e-300, 1e-18]) | logarithmic(1e-12, 3e-6))
    is_constant = draw(st.booleans())
    F_C = draw(logarithmic(1e-3, 1e4))
    return {
        "V": V,
        "d": d,
        "E": draw(logarithmic(1e9, 1e12)),
        "F_C": F_C,
        "contact.model": "Constant" if is_constant else "Asperities",
        "contact.sigma": draw(logarithmic(1e2, 1e14)),
        "contact.stiffnessScale": draw(logarithmic(1e-10, 1e2)),
        "vibration.f": FREQUENCY,
        "vibration.V_1": V_1,
        "vibration.a_d": a_d,
        "vibration.phase_d": draw(st.floats(-10.0, 10.0)),
        "solver.tolerance": TOLERANCE,
    }


durations = logarithmic(1e-4, 1e3).map(lambda periods: periods * PERIOD)
fractions = st.floats(-1.0, 1.0)


@st.composite
def ramps(draw: st.DrawFn, values: dict[str, Any], h: float) -> dict[str, float]:
    """Input derivatives, such that the inputs move by their own size over h; none in half the scenes."""
    if draw(st.booleans()) or h * FREQUENCY > 20:
        return {}
    speed = max(abs(values["V"]), values["vibration.V_1"])
    return {
        "V": draw(st.floats(-2.0, 2.0)) * speed / h,
        "d": draw(st.floats(-1e-6, 1e-6)) / h,
        "E": draw(st.floats(-0.4, 0.4)) * values["E"] / h,
    }


def run(
    fmu: FrictionFmu,
    values: dict[str, Any],
    deflection: float,
    steps: list[float],
    rates: dict[str, float] | None = None,
    start: float = 0.0,
) -> dict[str, float]:
    """Outputs after the steps; F_t_mean over all of them. The deflection is over F_C / sigma at the start."""
    with fmu.session(values, start) as session:
        delta_0 = deflection * values["F_C"] / session.get("sigma")
    impulse, inputs = 0.0, {name: values[name] for name in rates or {}}
    with fmu.session(values | {"delta_0": delta_0}, start) as session:
        for h in steps:
            if rates:
                for name, value in inputs.items():
                    session.set(name, value)
                session.set_rates(**rates)
            session.step(h)
            impulse += h * session.get("F_t_mean")
            inputs = {name: value + h * rates[name] for name, value in inputs.items()} if rates else {}
        outputs = dict(zip(OUTPUTS, session.read(), strict=True))
    outputs["F_t_mean"] = impulse / sum(steps)
    outputs["delta_0"] = delta_0
    return outputs


def force_scale(outputs: dict[str, float], values: dict[str, Any]) -> float:
    """F_C, or the force where a moving separation has carried it beyond."""
    return max(values["F_C"], abs(outputs["F_t"]), abs(outputs["F_t_mean"]))


@every_scene
@given(data=st.data(), values=scenes(), h=durations, deflection=fractions)
def test_cycle_identity_where_the_velocity_keeps_its_sign(
    fmu: FrictionFmu, data: st.DataObject, values: dict, h: float, deflection: float
) -> None:
    """W = F_C (path - s (delta_1 - delta_0)), whatever sigma(t) does."""
    values["V"] = math.copysign(abs(values["V"]) + values["vibration.V_1"], values["V"])
    rates = data.draw(ramps(values, h))
    if rates:
        rates["V"] = abs(rates["V"]) * math.copysign(1.0, values["V"])
    out = run(fmu, values, deflection, [h], rates)
    theta = 2 * math.pi * math.fmod(FREQUENCY * h, 1.0)
    displacement = values["V"] * h + values["vibration.V_1"] * math.sin(theta) / (2 * math.pi * FREQUENCY)
    displacement += 0.5 * rates.get("V", 0.0) * h * h
    s = math.copysign(1.0, values["V"])
    expected = values["F_C"] * (abs(displacement) - s * (out["delta"] - out["delta_0"]))
    scale = values["F_C"] * max(abs(displacement), abs(out["delta"]), abs(out["delta_0"]), 1e-280)
    force = force_scale(out, values) / values["F_C"]
    assert out["W_f"] == pytest.approx(expected, abs=(values["solver.tolerance"] * force + 1e-11) * scale)


@every_scene
@given(data=st.data(), values=scenes(), h=durations, deflection=fractions, periods=st.integers(1, 2**30))
def test_a_step_in_parts_and_later(
    fmu: FrictionFmu, data: st.DataObject, values: dict, h: float, deflection: float, periods: int
) -> None:
    """A hundred parts agree within two tolerances; whole periods later all bits are the same.

    Local time keeps even a late step exact. The duration is a multiple of 2^-36 s: no end is rounded.
    """
    h = math.ceil(h * 2.0**36) / 2.0**36
    rates = data.draw(ramps(values, h))
    whole = run(fmu, values, deflection, [h], rates)
    assert run(fmu, values, deflection, [h], rates, start=periods * PERIOD) == whole
    parts = run(fmu, values, deflection, [h / 100] * 100, rates)
    scale = 2 * TOLERANCE * force_scale(whole, values)
    assert parts["F_t"] == pytest.approx(whole["F_t"], abs=scale)
    assert parts["F_t_mean"] == pytest.approx(whole["F_t_mean"], abs=scale)
