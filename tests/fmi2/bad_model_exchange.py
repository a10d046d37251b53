"""Wrong calls and values in model exchange, and all groups of wrong calls together."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_double, c_int
from typing import Any

from bad_calls import GROUPS, INF, NAN, BadCall
from fmi_library import INDICATORS, MODEL_EXCHANGE, STATES, Instance

CONTINUOUS = "continuous-time mode"


def _bad(
    title: str, state: str, call: Callable[[Instance], int], told: tuple[str, ...], **more: Any
) -> BadCall:
    return BadCall(title, state, call, told, kind=MODEL_EXCHANGE, **more)


def _states(title: str, values: tuple[float, ...], *told: str) -> BadCall:
    return _bad(title, CONTINUOUS, lambda i: i.put_states(*values), ("fmi2SetContinuousStates: ", *told))


def _array(function: str, state: str, wanted: int, what: str) -> list[BadCall]:
    """A wrong number, and no array."""
    room = (c_double * 9)()
    few = (f"{function}: {wanted - 1} {what} are asked for; there are {wanted}",)
    return [
        _bad(f"{function} of {wanted - 1}", state, lambda i: i.call(function, room, wanted - 1), few),
        _bad(f"{function} without an array", state, lambda i: i.call(function, None, wanted), ("is NULL",)),
    ]


def _parameter(name: str, state: str, told: str) -> BadCall:
    return _bad(f"{name} set in {state}", state, lambda i: i.set({name: 1e-6}), (name, told))


def _too_close(title: str, call: Callable[[Instance], int], function: str) -> BadCall:
    """Surfaces that would touch: an input that an integrator tries may do that."""
    return _bad(
        f"{title} while d = 5e-7 m is below vibration.a_d = 1e-6 m",
        CONTINUOUS,
        call,
        (f"{function}: ", "vibration.a_d = 1e-06 m must be below d = 5e-07 m"),
        setup=lambda i: i.set({"vibration.a_d": 1e-6}),
        prepare=lambda i: i.set({"d": 5e-7}),
        mend=lambda i: i.set({"d": 14e-6}),
    )


def _after_the_stop_time(function: str, *arguments: object) -> BadCall:
    return _bad(
        f"{function} after the stop time",
        CONTINUOUS,
        lambda i: i.call(function, *arguments),
        (f"{function}: time = 0.75 s is after the stop time 0.5 s",),
        setup=lambda i: i.set_up(0.0, 0.5),
        prepare=lambda i: i.call("fmi2SetTime", 0.75),
        mend=lambda i: i.call("fmi2SetTime", 0.0),
    )


CALLS = [
    _bad(
        "leaving initialization mode with friction.model = Coulomb",
        "initialization",
        lambda i: i.call("fmi2ExitInitializationMode"),
        (
            "fmi2ExitInitializationMode: friction.model = Coulomb (2) is not for model exchange: ",
            "it has no state",
            "take ElasticPlastic (3)",
        ),
        prepare=lambda i: i.choose({"friction.model": 2}),
        mend=lambda i: i.choose({"friction.model": 1}),
    ),
    *(
        _bad(
            f"fmi2SetTime to {time:g}",
            CONTINUOUS,
            lambda i, t=time: i.call("fmi2SetTime", t),
            (f"fmi2SetTime: time = {time:g} s is not a finite number",),
        )
        for time in (NAN, INF)
    ),
    _states("delta NaN", (NAN, 0.0, 0.0), "delta = nan m is not a finite number"),
    _states("W_f infinite", (0.0, INF, 0.0), "W_f = inf J is not a finite number"),
    _states("Q_f NaN", (0.0, 0.0, NAN), "Q_f = nan J is not a finite number"),
    *_array("fmi2SetContinuousStates", CONTINUOUS, STATES, "continuous states"),
    *_array("fmi2GetContinuousStates", CONTINUOUS, STATES, "continuous states"),
    *_array("fmi2GetDerivatives", CONTINUOUS, STATES, "derivatives"),
    *_array("fmi2GetEventIndicators", "event mode", INDICATORS, "event indicators"),
    *_array("fmi2GetNominalsOfContinuousStates", "event mode", STATES, "nominal values"),
    _bad(
        "fmi2NewDiscreteStates without a place for the answer",
        "event mode",
        lambda i: i.call("fmi2NewDiscreteStates", None),
        ("eventInfo is NULL",),
    ),
    _bad(
        "fmi2CompletedIntegratorStep without a place for the answer",
        CONTINUOUS,
        lambda i: i.call("fmi2CompletedIntegratorStep", 1, None, (c_int * 1)()),
        ("enterEventMode or terminateSimulation is NULL",),
    ),
    _after_the_stop_time("fmi2EnterEventMode"),
    _after_the_stop_time("fmi2CompletedIntegratorStep", 1, (c_int * 1)(), (c_int * 1)()),
    _parameter("F_C", CONTINUOUS, "in model exchange it can be set in event mode"),
    _parameter("delta_0", CONTINUOUS, "is a fixed parameter and can't be set after initialization"),
    _parameter("contact.R_q", "event mode", "is a fixed parameter and can't be set after initialization"),
    _parameter("delta", "event mode", "is an output variable and can't be set"),
    _parameter("F_t", CONTINUOUS, "is an output variable and can't be set"),
    _parameter("der(delta)", CONTINUOUS, "is a local variable and can't be set"),
    _bad("V = nan", CONTINUOUS, lambda i: i.set({"V": NAN}), ("V = nan m/s is not a finite number",)),
    _bad("d = 0", CONTINUOUS, lambda i: i.set({"d": 0.0}), ("d = 0 m is below its minimum 1e-12 m",)),
    _too_close(
        "fmi2GetDerivatives",
        lambda i: i.call("fmi2GetDerivatives", (c_double * STATES)(), STATES),
        "fmi2GetDerivatives",
    ),
    _too_close(
        "fmi2GetEventIndicators",
        lambda i: i.call("fmi2GetEventIndicators", (c_double * INDICATORS)(), INDICATORS),
        "fmi2GetEventIndicators",
    ),
    _too_close(
        "a directional derivative",
        lambda i: i.directional(["der(delta)"], {"V": 1.0})[0],
        "fmi2GetDirectionalDerivative",
    ),
    _bad(
        "fmi2GetDerivatives where sigma delta overflows",
        CONTINUOUS,
        lambda i: i.call("fmi2GetDerivatives", (c_double * STATES)(), STATES),
        (
            "fmi2GetDerivatives: F_t or the rate of delta, W_f or Q_f is beyond the largest number",
            "delta = 1e+303 m",
        ),
        prepare=lambda i: i.put_states(1e303, 0.0, 0.0),
        mend=lambda i: i.put_states(0.0, 0.0, 0.0),
    ),
    _bad(
        "a directional derivative to a rate",
        CONTINUOUS,
        lambda i: i.directional(["F_t"], {"der(delta)": 1.0})[0],
        ("der(delta)", "is not an input"),
    ),
    _bad(
        "a directional derivative along a state that is NaN",
        CONTINUOUS,
        lambda i: i.directional(["F_t"], {"delta": NAN})[0],
        ("direction of delta = nan m is not a finite number",),
    ),
]
ALL_GROUPS = {**GROUPS, "Model exchange": CALLS}
ALL_CALLS = [bad for group in ALL_GROUPS.values() for bad in group]
