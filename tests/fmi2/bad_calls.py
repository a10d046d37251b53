"""One wrong call of each kind, with what its message has to name. The state afterwards is the one before."""

from __future__ import annotations

import math
from collections.abc import Callable
from ctypes import c_char_p, c_double, c_int, c_uint
from dataclasses import dataclass
from typing import Any

from fmi_library import CO_SIMULATION, MODEL_EXCHANGE, STATES, Instance

BETWEEN_STEPS, CONTINUOUS = "step complete", "continuous-time mode"


def _nothing(_instance: Instance) -> None:
    pass


@dataclass(frozen=True)
class BadCall:
    title: str
    state: str  # where it is tried
    call: Callable[[Instance], int]
    named: tuple[str, ...]  # in the message: the function, the variable, its value, its bound
    setup: Callable[[Instance], object] = _nothing  # when instantiated
    prepare: Callable[[Instance], object] = _nothing  # in the state where it is tried
    mend: Callable[[Instance], object] = _nothing  # before the run goes on
    kind: int = CO_SIMULATION


def _set(name: str, value: float, *named: str, state: str = BETWEEN_STEPS) -> BadCall:
    title = f"{name} = {value:g}"
    return BadCall(title, state, lambda i: i.set({name: value}), ("fmi2SetReal", name, *named))


def _choose(name: str, value: int, *named: str, state: str) -> BadCall:
    return BadCall(f"{name} = {value}", state, lambda i: i.choose({name: value}), (name, *named))


def _step(title: str, t: float, h: float, *named: str) -> BadCall:
    return BadCall(title, BETWEEN_STEPS, lambda i: i.step(t, h), ("fmi2DoStep", *named))


def _moved(name: str, rate: float, h: float, *named: str, **values: float) -> BadCall:
    """A step in which a derivative moves an input too far."""
    return BadCall(
        f"step of {h:g} s with the derivative {rate:g} of {name}",
        BETWEEN_STEPS,
        lambda i: i.step(0.0, h),
        ("fmi2DoStep", *named),
        prepare=lambda i: (i.set(values), i.set_input_rates({name: rate})),
        mend=lambda i: i.set_input_rates({name: 0.0}),
    )


INSTANTIATIONS: dict[str, tuple[dict[str, Any], str]] = {  # the arguments and the message
    "another FMU's guid": (
        {"guid": "{00000000-0000-0000-0000-000000000000}"},
        "the guid is {00000000-0000-0000-0000-000000000000}",
    ),
    "fmuType = 17": ({"kind": 17}, "fmuType = 17 is neither fmi2ModelExchange (0) nor fmi2CoSimulation (1)"),
    "an empty instance name": ({"name": ""}, "the instance name is"),
    "no instance name": ({"name": None}, "the instance name is missing"),
}

CALLS = [
    _set("V", math.nan, "nan"),
    BadCall(
        "a step with d = 0",
        BETWEEN_STEPS,
        lambda i: i.step(0.0, 1e-5),
        ("fmi2DoStep", "d = 0 m", "above 0 m", "not connected"),
        prepare=lambda i: i.set({"d": 0.0}),
        mend=lambda i: i.set({"d": 14e-6}),
    ),
    _set("F_C", -55.0, "-55", "1e-12"),
    _set("contact.nu", 0.6, "0.6", "0.5", state="instantiated"),
    _set("solver.tolerance", 0.0, "0", "1e-12", state="initialization"),
    _set("contact.R_q", 1e-6, "fixed"),
    _set("F_t", 1.0, "output", state="instantiated"),
    _choose("friction.model", 99, "99", "4 (LuGre)", state="initialization"),
    BadCall(
        "fmi2GetReal of an unknown value reference",
        BETWEEN_STEPS,
        lambda i: i.call("fmi2GetReal", (c_uint * 1)(4294967295), 1, (c_double * 1)()),
        ("fmi2GetReal", "4294967295"),
    ),
    BadCall(
        "fmi2SetInteger of a Real",
        BETWEEN_STEPS,
        lambda i: i.choose({"V": 1}),
        ("fmi2SetInteger", "V", "Real", "Integer"),
    ),
    BadCall(
        "fmi2SetReal without values",
        BETWEEN_STEPS,
        lambda i: i.call("fmi2SetReal", (c_uint * 1)(0), 1, None),
        ("fmi2SetReal", "NULL"),
    ),
    _step("step size -1e-5", 0.0, -1e-5, "communicationStepSize", "-1e-05"),
    _step("time ahead of the instance", 1e-5, 1e-5, "currentCommunicationPoint", "1e-05"),
    BadCall(
        "stop time before start time",
        "instantiated",
        lambda i: i.call("fmi2SetupExperiment", 0, 0.0, 2.0, 1, 1.0),
        ("stopTime = 1", "startTime = 2"),
    ),
    BadCall(
        "stop time that is no number",
        "instantiated",
        lambda i: i.call("fmi2SetupExperiment", 0, 0.0, 2.0, 1, float("nan")),
        ("stopTime", "nan"),
    ),
    BadCall(
        "input derivative of order 2",
        BETWEEN_STEPS,
        lambda i: i.set_input_rates({"V": 1.0}, order=2),
        ("order = 2", "V"),
    ),
    BadCall(
        "directional derivative in a fixed parameter",
        BETWEEN_STEPS,
        lambda i: i.directional(["F_t"], {"contact.R_q": 1.0})[0],
        ("contact.R_q", "tunable"),
    ),
    BadCall(
        "unknown log category",
        BETWEEN_STEPS,
        lambda i: i.call("fmi2SetDebugLogging", 1, 1, (c_char_p * 1)(b"logEverything")),
        ("logEverything",),
    ),
    _moved("d", -0.2, 1e-4, "d ", "1.4e-05", "-6e-06"),
    _moved("E", 1e16, 1e-4, "E "),
    _moved("E", 9.1 * 58.556936e13, 1e-4, "E ", "5.8556"),  # to 10.1 times its value
    _moved("E", -0.901 * 58.556936e13, 1e-4, "E ", "5.8556"),  # to 0.099
    _moved("V", 1.7e308, 1e4, "V"),
    _moved("V", 1e-6, 100.0, "50 s", **{"vibration.V_1": 0.4}),
    BadCall(
        "explicitEuler beyond its stability limit",
        BETWEEN_STEPS,
        lambda i: i.step(0.0, 1e-6),
        ("fmi2DoStep", "solver.method", "solver.stepSize"),
        setup=lambda i: i.choose({"solver.method": 6}),
        mend=lambda i: i.set({"contact.stiffnessScale": 1e-4}),
    ),
    BadCall(
        "a step while vibration.a_d = 20e-6 m exceeds d = 14e-6 m",
        BETWEEN_STEPS,
        lambda i: i.step(0.0, 1e-5),
        ("fmi2DoStep", "vibration.a_d", "2e-05", "1.4e-05"),
        prepare=lambda i: i.set({"vibration.a_d": 20e-6}),
        mend=lambda i: i.set({"vibration.a_d": 0.0}),
    ),
    BadCall(
        "leaving initialization mode with friction.model = Coulomb",
        "initialization",
        lambda i: i.call("fmi2ExitInitializationMode"),
        ("friction.model", "Coulomb", "ElasticPlastic"),
        prepare=lambda i: i.choose({"friction.model": 2}),
        mend=lambda i: i.choose({"friction.model": 1}),
        kind=MODEL_EXCHANGE,
    ),
    BadCall(
        "delta NaN",
        CONTINUOUS,
        lambda i: i.put_states(math.nan, 0.0, 0.0),
        ("fmi2SetContinuousStates", "delta", "nan"),
        kind=MODEL_EXCHANGE,
    ),
    BadCall(
        "one state too few",
        CONTINUOUS,
        lambda i: i.call("fmi2SetContinuousStates", (c_double * STATES)(), STATES - 1),
        ("fmi2SetContinuousStates", str(STATES - 1), str(STATES)),
        kind=MODEL_EXCHANGE,
    ),
    BadCall(
        "contact.R_q set in continuous-time mode",
        CONTINUOUS,
        lambda i: i.set({"contact.R_q": 5e-6}),
        ("contact.R_q", "fixed"),
        kind=MODEL_EXCHANGE,
    ),
    BadCall(
        "fmi2CompletedIntegratorStep without a place for the answer",
        CONTINUOUS,
        lambda i: i.call("fmi2CompletedIntegratorStep", 1, None, (c_int * 1)()),
        ("enterEventMode", "NULL"),
        kind=MODEL_EXCHANGE,
    ),
]
