"""Wrong calls and values, each with what the host is told. The state afterwards is the one before."""

from __future__ import annotations

import math
from collections.abc import Callable
from ctypes import byref, c_char_p, c_double, c_int, c_uint, c_void_p
from dataclasses import dataclass

from fmi_library import CO_SIMULATION, Instance

NAN, INF = math.nan, math.inf


def _nothing(_instance: Instance) -> None:
    pass


@dataclass(frozen=True)
class BadCall:
    title: str
    state: str  # where it is tried
    call: Callable[[Instance], int]
    told: tuple[str, ...]  # parts of the message
    setup: Callable[[Instance], object] = _nothing  # when instantiated
    prepare: Callable[[Instance], object] = _nothing  # in the state where it is tried
    mend: Callable[[Instance], object] = _nothing  # before the run goes on
    kind: int = CO_SIMULATION


def _set(name: str, value: float, *told: str, state: str = "step complete") -> BadCall:
    title = f"{name} = {value:g}"
    return BadCall(
        title, state, lambda instance: instance.set({name: value}), (f"fmi2SetReal: {name} = ", *told)
    )


def _choose(name: str, value: int, *told: str, state: str = "instantiated") -> BadCall:
    return BadCall(f"{name} = {value}", state, lambda instance: instance.choose({name: value}), (name, *told))


def _step(title: str, t: float, h: float, *told: str) -> BadCall:
    return BadCall(title, "step complete", lambda instance: instance.step(t, h), ("fmi2DoStep: ", *told))


def _setup(title: str, told: tuple[str, ...], *arguments: float) -> BadCall:
    return BadCall(
        title, "instantiated", lambda instance: instance.call("fmi2SetupExperiment", *arguments), told
    )


def _references(*references: int) -> object:
    return (c_uint * len(references))(*references)


def _v_reference(instance: Instance) -> int:
    return instance.library.variables["V"].reference


NOT_FINITE = [
    _set(name, value, "is not a finite number")
    for name in ("V", "d", "E", "F_C", "contact.stiffnessScale", "vibration.V_1", "vibration.phase_d")
    for value in (NAN, INF, -INF)
]

OUT_OF_BOUNDS = [
    _set("d", 0.0, "0 m", "below its minimum 1e-12 m"),
    _set("d", -14e-6, "-1.4e-05 m", "below its minimum 1e-12 m"),
    _set("E", 0.0, "0 Pa", "below its minimum 1 Pa"),
    _set("E", -1e9, "-1000000000 Pa", "below its minimum 1 Pa"),
    _set("F_C", 0.0, "0 N", "below its minimum 1e-12 N"),
    _set("F_C", -55.0, "-55 N", "below its minimum 1e-12 N"),
    _set("contact.sigma", 0.0, "below its minimum 1e-06 N/m"),
    _set("contact.stiffnessScale", -1.0, "= -1 is below its minimum 1e-15"),
    _set("vibration.f", 0.0, "0 Hz", "below its minimum 1e-06 Hz"),
    _set("vibration.f", 1e16, "1e+16 Hz", "above its maximum 1e+15 Hz"),
    _set("vibration.V_1", -1.0, "-1 m/s", "below its minimum 0 m/s"),
    _set("vibration.a_d", -1e-6, "-1e-06 m", "below its minimum 0 m"),
    _set("contact.nu", 0.6, "0.6", "above its maximum 0.5", state="instantiated"),
    _set("contact.R_q", 0.0, "below its minimum 1e-12 m", state="instantiated"),
    _set("contact.lambda", -3.0, "below its minimum 1e-06", state="initialization"),
    _set("solver.tolerance", 0.0, "below its minimum 1e-12", state="instantiated"),
    _set("solver.tolerance", 1.0, "above its maximum 0.01", state="instantiated"),
    _set("solver.stepSize", -1e-8, "below its minimum 1e-15 s", state="initialization"),
    _choose("friction.model", 0, "= 0 is not one of its values: 1 (Dahl), 2 (Coulomb), "),
    _choose("friction.model", 5, "= 5 is not one of its values", state="initialization"),
    _choose("contact.model", -1, "= -1 is not one of its values: 1 (Asperities), 2 (Constant), 3 (Mindlin)"),
    _choose("solver.method", 7, "= 7 is not one of its values: 1 (collocation), 2 (cvode)"),
]

NOT_SETTABLE = [
    BadCall(
        f"{name} set between steps",
        "step complete",
        lambda i, n=name: i.set({n: 1e-6}),
        (name, "fixed parameter"),
    )
    for name in ("delta_0", "contact.R_q", "solver.tolerance", "solver.stepSize")
] + [
    BadCall(
        f"{name} set between steps",
        "step complete",
        lambda i, n=name: i.choose({n: 1}),
        (name, "fixed parameter"),
    )
    for name in ("friction.model", "contact.model", "solver.method")
]
NOT_SETTABLE += [
    BadCall(
        f"{name} set in state {state}", state, lambda i, n=name: i.set({n: 1.0}), (name, kind, "can't be set")
    )
    for state in ("instantiated", "initialization", "step complete")
    for name, kind in (("F_t", "an output"), ("delta", "an output"), ("solver.evaluations", "a local"))
]

WRONG_REFERENCE = [
    BadCall(
        "fmi2GetReal of an unknown value reference",
        "step complete",
        lambda i: i.call("fmi2GetReal", _references(46), 1, (c_double * 1)()),  # the one after the last
        ("fmi2GetReal: value reference 46 is unknown",),
    ),
    BadCall(
        "fmi2SetReal of an unknown value reference",
        "step complete",
        lambda i: i.call(
            "fmi2SetReal", _references(_v_reference(i), 4294967295), 2, (c_double * 2)(0.7, 0.7)
        ),
        ("fmi2SetReal: value reference 4294967295 is unknown",),
    ),
    BadCall(
        "fmi2GetInteger of a Real",
        "step complete",
        lambda i: i.call("fmi2GetInteger", _references(_v_reference(i)), 1, (c_int * 1)()),
        ("fmi2GetInteger: V", "is a Real, not an Integer"),
    ),
    BadCall(
        "fmi2SetInteger of a Real",
        "step complete",
        lambda i: i.choose({"V": 1}),
        ("fmi2SetInteger: V", "is a Real, not an Integer"),
    ),
    BadCall(
        "fmi2SetReal of an Enumeration",
        "instantiated",
        lambda i: i.set({"friction.model": 1.0}),
        ("fmi2SetReal: friction.model", "is an Enumeration: use the Integer functions"),
    ),
    BadCall(
        "fmi2GetBoolean of a Real",
        "step complete",
        lambda i: i.call("fmi2GetBoolean", _references(_v_reference(i)), 1, (c_int * 1)()),
        ("fmi2GetBoolean: V", "is a Real, not a Boolean"),
    ),
    BadCall(
        "fmi2SetBoolean of an unknown value reference",
        "step complete",
        lambda i: i.call("fmi2SetBoolean", _references(99), 1, (c_int * 1)()),
        ("fmi2SetBoolean: value reference 99 is unknown",),
    ),
    BadCall(
        "fmi2GetString of a Real",
        "step complete",
        lambda i: i.call("fmi2GetString", _references(_v_reference(i)), 1, (c_char_p * 1)()),
        ("fmi2GetString: V", "is a Real, not a String"),
    ),
    BadCall(
        "fmi2SetString of a Real",
        "step complete",
        lambda i: i.call("fmi2SetString", _references(_v_reference(i)), 1, (c_char_p * 1)(b"1")),
        ("fmi2SetString: V", "is a Real, not a String"),
    ),
]

NULL_POINTERS = [
    BadCall(
        f"{function} without {missing}",
        "step complete",
        lambda i, f=function, a=arguments: i.call(f, *a),
        (f"{function}: ", "NULL"),
    )
    for function, missing, arguments in (
        ("fmi2GetReal", "vr", (None, 1, (c_double * 1)())),
        ("fmi2GetReal", "value", (_references(0), 1, None)),
        ("fmi2SetReal", "vr", (None, 1, (c_double * 1)())),
        ("fmi2SetReal", "value", (_references(0), 1, None)),
        ("fmi2GetInteger", "value", (_references(11), 1, None)),
        ("fmi2SetInteger", "value", (_references(11), 1, None)),
        ("fmi2GetBoolean", "vr", (None, 1, (c_int * 1)())),
        ("fmi2SetString", "vr", (None, 1, (c_char_p * 1)())),
        ("fmi2SetDebugLogging", "categories", (1, 1, None)),
        ("fmi2SetDebugLogging", "a category", (1, 1, (c_char_p * 1)())),
        ("fmi2SetRealInputDerivatives", "order", (_references(0), 1, None, (c_double * 1)())),
        ("fmi2GetRealOutputDerivatives", "value", (_references(3), 1, (c_int * 1)(1), None)),
        (
            "fmi2GetDirectionalDerivative",
            "dvKnown",
            (_references(3), 1, _references(0), 1, None, (c_double * 1)()),
        ),
        ("fmi2GetFMUstate", "the place for the state", (None,)),
        ("fmi2SetFMUstate", "a state", (None,)),
        ("fmi2SerializedFMUstateSize", "a state", (None, None)),
        ("fmi2SerializeFMUstate", "a state", (None, None, 0)),
        ("fmi2DeSerializeFMUstate", "bytes", (None, 0, byref(c_void_p()))),
        ("fmi2GetRealStatus", "value", (2, None)),
        ("fmi2GetBooleanStatus", "value", (3, None)),
    )
]

BAD_STEPS = [
    _step("step size -1e-5", 0.0, -1e-5, "communicationStepSize = -1e-05 s must be finite and at least 0 s"),
    _step("step size NaN", 0.0, NAN, "communicationStepSize = nan s"),
    _step("step size infinite", 0.0, INF, "communicationStepSize = inf s"),
    _step("step size 5e-324", 0.0, 5e-324, "h must be 0 s, or a finite number of at least 2.22507386e-308 s"),
    _step("time NaN", NAN, 1e-5, "currentCommunicationPoint = nan s, but the instance is at 0 s"),
    _step("time infinite", INF, 1e-5, "currentCommunicationPoint = inf s"),
    _step(
        "time ahead of the instance",
        1e-5,
        1e-5,
        "currentCommunicationPoint = 1e-05 s, but the instance is at 0 s",
    ),
    _step("time behind the instance", -1e-5, 1e-5, "currentCommunicationPoint = -1e-05 s"),
]

BAD_EXPERIMENTS = [
    _setup("tolerance NaN", ("tolerance = nan",), 1, NAN, 0.0, 0, 0.0),
    _setup("start time NaN", ("startTime = nan s",), 0, 0.0, NAN, 0, 0.0),
    _setup("start time infinite", ("startTime = inf s",), 0, 0.0, INF, 0, 0.0),
    _setup("stop time NaN", ("stopTime = nan s",), 0, 0.0, 0.0, 1, NAN),
    _setup("stop time before start time", ("stopTime = 1 s is before startTime = 2 s",), 0, 0.0, 2.0, 1, 1.0),
]

BAD_DERIVATIVES = [
    BadCall(
        "input derivative of order 2",
        "step complete",
        lambda i: i.set_input_rates({"V": 1.0}, order=2),
        ("order = 2 of V", "only order 1"),
    ),
    BadCall(
        "input derivative of an output",
        "step complete",
        lambda i: i.set_input_rates({"F_t": 1.0}),
        ("F_t", "is not an input"),
    ),
    BadCall(
        "input derivative NaN",
        "step complete",
        lambda i: i.set_input_rates({"V": 1.0, "d": NAN}),
        ("derivative of d = nan m per s is not a finite number",),
    ),
    BadCall(
        "output derivative of order 2",
        "step complete",
        lambda i: i.output_rate("F_t", order=2)[0],
        ("order = 2 of F_t", "only order 1"),
    ),
    BadCall(
        "output derivative of sigma",
        "step complete",
        lambda i: i.output_rate("sigma")[0],
        ("sigma has no derivative in time here: only F_t has",),
    ),
    BadCall(
        "output derivative of an input",
        "step complete",
        lambda i: i.output_rate("V")[0],
        ("V", "is not an output"),
    ),
    BadCall(
        "directional derivative of an input",
        "step complete",
        lambda i: i.directional(["d"], {"V": 1.0})[0],
        ("d", "is not an output"),
    ),
    BadCall(
        "directional derivative to a parameter",
        "step complete",
        lambda i: i.directional(["F_t"], {"F_C": 1.0})[0],
        ("F_C", "is not an input"),
    ),
    BadCall(
        "directional derivative along NaN",
        "step complete",
        lambda i: i.directional(["F_t"], {"V": NAN})[0],
        ("direction of V = nan m/s is not a finite number",),
    ),
]

BAD_DERIVATIVES += [
    BadCall(
        "directional derivative of an unknown value reference",
        "step complete",
        lambda i: i.call("fmi2GetDirectionalDerivative", _references(99), 1, None, 0, None, (c_double * 1)()),
        ("value reference 99 is unknown",),
    ),
]


def _with_saved_state(instance: Instance, function: str, *arguments: object) -> int:
    state = instance.save()
    status = instance.call(function, state, *arguments)
    instance.drop(state)
    return status


OTHERS = [
    BadCall(
        "fmi2SerializedFMUstateSize without a place for the size",
        "step complete",
        lambda i: _with_saved_state(i, "fmi2SerializedFMUstateSize", None),
        ("size is NULL",),
    ),
    BadCall(
        "fmi2SerializeFMUstate without a place for the bytes",
        "step complete",
        lambda i: _with_saved_state(i, "fmi2SerializeFMUstate", None, 1000),
        ("serializedState is NULL",),
    ),
    BadCall(
        "fmi2DeSerializeFMUstate without a place for the state",
        "step complete",
        lambda i: i.call("fmi2DeSerializeFMUstate", data := i.fingerprint(), len(data), None),
        ("the pointer to FMUstate is NULL",),
    ),
    BadCall(
        "unknown log category",
        "step complete",
        lambda i: i.call("fmi2SetDebugLogging", 1, 2, (c_char_p * 2)(b"logEvents", b"logEverything")),
        ("log category 'logEverything' is unknown",),
    ),
    BadCall(
        "fmi2GetRealStatus of fmi2DoStepStatus",
        "step complete",
        lambda i: i.call("fmi2GetRealStatus", 0, (c_double * 1)()),
        ("only fmi2LastSuccessfulTime",),
    ),
    BadCall(
        "fmi2GetBooleanStatus of an unknown kind",
        "step complete",
        lambda i: i.call("fmi2GetBooleanStatus", 99, (c_int * 1)()),
        ("status kind 99",),
    ),
    BadCall(
        "fmi2GetStatus of fmi2DoStepStatus",
        "step complete",
        lambda i: i.call("fmi2GetStatus", 0, (c_int * 1)()),
        ("synchronous",),
    ),
    BadCall(
        "a state that is none",
        "step complete",
        lambda i: i.call("fmi2SetFMUstate", (c_double * 100)()),
        ("not a state of this FMU",),
    ),
]


def _driven(name: str, rate: float, h: float, *told: str) -> BadCall:
    return BadCall(
        f"step of {h:g} s with the derivative {rate:g} of {name}",
        "step complete",
        lambda i: i.step(0.0, h),
        ("fmi2DoStep: ", *told),
        prepare=lambda i: i.set_input_rates({name: rate}),
        mend=lambda i: i.set_input_rates({name: 0.0}),
    )


def _slow_method(title: str, method: int, values: dict[str, float], h: float, *told: str) -> BadCall:
    return BadCall(
        title,
        "step complete",
        lambda i: i.step(0.0, h),
        ("fmi2DoStep: ", *told),
        setup=lambda i: i.choose({"solver.method": method}),
        prepare=lambda i: i.set(values),
        mend=lambda i: i.set({"contact.stiffnessScale": 1e-4}),
    )


COMBINATIONS = [
    *(
        BadCall(
            f"{title} while vibration.a_d = 20e-6 m exceeds d = 14e-6 m",
            "step complete",
            call,
            (function, "vibration.a_d = 2e-05 m must be below d = 1.4e-05 m"),
            prepare=lambda i: i.set({"vibration.a_d": 20e-6}),
            mend=lambda i: i.set({"vibration.a_d": 0.0}),
        )
        for title, function, call in (
            ("a step", "fmi2DoStep: ", lambda i: i.step(0.0, 1e-5)),
            (
                "reading an output",
                "fmi2GetReal: ",
                lambda i: i.call("fmi2GetReal", i.references(["F_t"]), 1, (c_double * 1)()),
            ),
        )
    ),
    BadCall(
        "leaving initialization mode while vibration.a_d = 20e-6 m exceeds d = 14e-6 m",
        "initialization",
        lambda i: i.call("fmi2ExitInitializationMode"),
        ("fmi2ExitInitializationMode: vibration.a_d = 2e-05 m must be below d = 1.4e-05 m",),
        prepare=lambda i: i.set({"vibration.a_d": 20e-6}),
        mend=lambda i: i.set({"vibration.a_d": 0.0}),
    ),
    BadCall(
        "leaving initialization mode while sigma delta_0 overflows",
        "initialization",
        lambda i: i.call("fmi2ExitInitializationMode"),
        ("fmi2ExitInitializationMode: F_t = sigma delta is beyond", "delta = 1e+303 m"),
        prepare=lambda i: i.set({"delta_0": 1e303}),
        mend=lambda i: i.set({"delta_0": 0.0}),
    ),
    BadCall(
        "leaving initialization mode at a speed that no step can compute",
        "initialization",
        lambda i: i.call("fmi2ExitInitializationMode"),
        (
            "fmi2ExitInitializationMode: V = 0.005 m/s with vibration.V_1 = 1e+30 m/s",
            "the speed must stay at most 1e+15 m/s",
        ),
        prepare=lambda i: i.set({"vibration.V_1": 1e30}),
        mend=lambda i: i.set({"vibration.V_1": 0.0}),
    ),
    BadCall(
        "reading F_t = sigma delta with contact.sigma raised until it overflows",
        "step complete",
        lambda i: i.call("fmi2GetReal", i.references(["F_t"]), 1, (c_double * 1)()),
        ("fmi2GetReal: the outputs can't be computed: F_t = sigma delta", "beyond the largest number"),
        setup=lambda i: (i.choose({"contact.model": 2}), i.set({"delta_0": 1e10})),
        prepare=lambda i: i.set({"contact.sigma": 1e300}),
        mend=lambda i: i.set({"contact.sigma": 2.5e6}),
    ),
    _driven("d", -1.0, 1e-4, "d moves from 1.4e-05 m to -8.6e-05 m", "at least 1e-12 m"),
    _driven("E", -1e15, 1e-4, "E moves from 58556936170 Pa", "at least 1 Pa"),
    _driven("V", 1e308, 1e3, "V moves from 0.005 m/s to inf m/s", "must stay finite"),
    BadCall(
        "a step of 1e10 s under a vibration of 20 kHz",
        "step complete",
        lambda i: i.step(0.0, 1e10),
        ("fmi2DoStep: time = 1e+10 s is too large for vibration.f = 20000 Hz", "beyond 3.51843721e+09 s"),
        prepare=lambda i: i.set({"vibration.V_1": 0.4}),
    ),
    BadCall(
        "a step in which d moves to 1e-6 m while vibration.a_d = 1.1e-6 m",
        "step complete",
        lambda i: i.step(0.0, 1e-4),
        (
            "fmi2DoStep: d moves from 1.4e-05 m to 1e-06 m in the step",
            "with vibration.a_d = 1.1e-06 m the separation must stay above 0 m",
        ),
        prepare=lambda i: (i.set({"vibration.a_d": 1.1e-6}), i.set_input_rates({"d": -0.13})),
        mend=lambda i: i.set_input_rates({"d": 0.0}),
    ),
    BadCall(
        "a step of 2e6 vibration periods while V moves",
        "step complete",
        lambda i: i.step(0.0, 100.0),
        ("fmi2DoStep: ", "2000000 vibration periods while an input moves", "the largest step is 50 s"),
        prepare=lambda i: (i.set({"vibration.V_1": 0.4}), i.set_input_rates({"V": 1e-6})),
        mend=lambda i: i.set_input_rates({"V": 0.0}),
    ),
    _slow_method(
        "explicitEuler beyond its stability limit",
        6,
        {"V": 0.01},
        1e-6,
        "solver.method = explicitEuler",
        "the largest usable step is",
    ),
    _slow_method("rk4 beyond its stability limit", 5, {"V": 0.01}, 1e-6, "solver.method = rk4"),
    _slow_method(
        "backwardEuler with 1e11 internal steps", 3, {"V": 0.1}, 1e3, "into 1e+11 steps; at most 1e+08"
    ),
]

GROUPS = {
    "Values that are not finite": NOT_FINITE,
    "Values out of bounds": OUT_OF_BOUNDS,
    "Variables that can't be set, or not now": NOT_SETTABLE,
    "Wrong value references and types": WRONG_REFERENCE,
    "Missing pointers": NULL_POINTERS,
    "Steps": BAD_STEPS,
    "The experiment": BAD_EXPERIMENTS,
    "Derivatives": BAD_DERIVATIVES,
    "Values that do not go together, and work without end": COMBINATIONS,
    "States, log and status": OTHERS,
}
