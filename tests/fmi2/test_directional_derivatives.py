"""fmi2GetDirectionalDerivative: outputs and rates by inputs and tunable parameters, against differences."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from fmi_library import CO_SIMULATION, ERROR, MODEL_EXCHANGE, OK, Instance

from tools.description import description, read

SETTLED = ("F_t_settled", "F_y_settled")
OUTPUTS = tuple(
    variable["name"]
    for variable in description()["variables"]
    if variable["causality"] == "output" and not variable["name"].endswith("_settled")
)
STEPS = {"V": 1e-6, "d": 1e-11, "E": 1e5, "load": 3e-4, "V_y": 1e-6}
ELASTIC_PLASTIC = {"friction.model": 3}
LIMIT_BY_LOAD, PRESSED = {"friction.limit": 2}, {"friction.limit": 2, "contact.input": 2}
DAMPED = {"friction.sigma_1": 20.0, "friction.sigma_2": 30.0}
STRIBECK = {"friction.staticRatio": 1.4, "friction.V_S": 0.01}
FORCES = ("F_t", "F_y")
LED = (*FORCES, "der(delta)", "der(delta_y)")  # by the bound, of a bristle that slips along it
# A bristle that slips stays on the bound while the bound comes nearer: where a variable moves this way.
NEARER = {"V": 1.0, "d": -1.0, "E": 1.0, "load": 1.0, "V_y": 1.0}
NEARER |= {"friction.mu": -1.0, "contact.stiffnessScale": 1.0}
VIBRATING_SURFACES = {"vibration.a_d": 1e-6, "vibration.phase_d": 0.7}
VIBRATING_SURFACES |= {"contact.stiffnessScale": 1e-5, "friction.sigma_1": 200.0}
SLIPPING = {
    "the limit follows the load": (LIMIT_BY_LOAD, {}),
    "in the plane": (PRESSED, {**VIBRATING_SURFACES, "V_y": 0.3}),
    "in the plane, while it turns": (PRESSED, {"delta_0": 1e-3, "contact.stiffnessScale": 1e-6, "V_y": 0.3}),
    "with static friction, in the plane": (PRESSED, {**STRIBECK, "V_y": 0.3, "friction.V_S": 0.5}),
}


@pytest.mark.parametrize("scene", SLIPPING)
def test_force_of_a_bristle_that_slips(new_instance: Callable[..., Instance], scene: str) -> None:
    """By one-sided differences, whose error falls with the step: extrapolated from two."""
    choices, values = SLIPPING[scene]
    instance = new_instance().start(ELASTIC_PLASTIC | choices, DAMPED | values | {"V": 0.5})
    assert instance.step(0.0, 1.23e-5) == OK
    for name, side in NEARER.items():
        status, exact = instance.directional(LED, {name: 1.0})
        assert status == OK
        start, *here = instance.get(name, *LED)
        small = STEPS.get(name, 1e-6 * start)
        slopes = []
        for step in (side * small, 2.0 * side * small):
            assert instance.set({name: start + step}) == OK
            slopes.append((np.array(instance.get(*LED)) - here) / step)
        assert instance.set({name: start}) == OK
        size = np.repeat([np.hypot(*here[:2]), 0.5], 2) / abs(start or 0.5)  # N, and V in m/s
        error = np.abs(np.array(exact) - (2.0 * slopes[0] - slopes[1]))
        assert (error <= 1e-5 * np.abs(exact) + 1e-6 * size).all(), (name, exact, slopes)


STIFF, SOFT = {"contact.sigma": 2e6}, {"contact.stiffnessScale": 4.4e-7}
JUMPS = {  # a sliding contact, and values that jump after a step
    "onto the kinetic bound, as V reverses": ({}, STIFF, {"contact.sigma": 4e6}),
    "inside both bounds, as V reverses": ({}, STIFF, {"contact.sigma": 2.6e6}),
    "the surfaces approach, as V reverses": ({"contact.model": 1}, SOFT, {"d": 13.8e-6}),
    "past a least bound, Dahl": (
        {"friction.model": 1, "contact.model": 1, **PRESSED},
        {**SOFT, "load": 312.44},
        {"load": 468.0, "E": 35.134e9, "V": 0.2},
    ),
}


@pytest.mark.parametrize("jump", JUMPS)
def test_after_a_jump_that_moves_the_bristle(new_instance: Callable[..., Instance], jump: str) -> None:
    choices, before, after = JUMPS[jump]
    instance = new_instance().start(
        ELASTIC_PLASTIC | {"contact.model": 2} | choices,
        {"friction.staticRatio": 1.5, "friction.V_S": 0.1, "V": 0.2} | before,
    )
    assert instance.step(0.0, 1e-3) == OK
    assert instance.set({"V": -0.15, **after}) == OK
    limits = ("F_C", "friction.mu", "friction.staticRatio", "friction.V_S", "contact.sigma")
    for name in ("V", "d", "E", "load", *limits):
        (start,) = instance.get(name)
        status, exact = instance.directional(FORCES, {name: 1.0})
        assert status == OK
        expected, smooth = by_richardson(instance, name, 1e-4 * abs(start), FORCES)
        assert smooth.all(), name
        size = np.hypot(*instance.get(*FORCES)) / abs(start)
        assert exact == pytest.approx(expected, rel=1e-8, abs=1e-8 * size), name


def test_a_direction_is_the_sum_of_its_parts(instance: Instance) -> None:
    instance.start(values={"delta_0": 2e-9})
    assert instance.step(0.0, 1e-9) == OK
    direction = {"V": 0.3, "d": -2e-7, "E": 4e8}
    parts = [instance.directional(OUTPUTS, {name: slope})[1] for name, slope in direction.items()]
    _, together = instance.directional(OUTPUTS, direction)
    assert together == [pytest.approx(sum(each), rel=1e-12, abs=0) for each in zip(*parts, strict=True)]
    assert instance.directional(OUTPUTS, {}) == (OK, [0.0] * len(OUTPUTS))
    assert instance.directional([], {"V": 1.0}) == (OK, [])


@pytest.mark.parametrize("d", [1e-11, 3e-10])
def test_a_jump_that_moves_the_bristle_a_little(instance: Instance, d: float) -> None:
    """On the bound F_t is mu F_n, and F_n goes with exp(-lambda d / R_q), though less d moves nothing."""
    instance.start({"friction.model": 1, "friction.limit": 2, "contact.model": 2}, {"V": 0.1})
    assert instance.step(0.0, 1e-2) == OK
    assert instance.set({"d": 14e-6 + d}) == OK
    status, (slope,) = instance.directional(["F_t"], {"d": 1.0})
    assert status == OK
    assert slope == pytest.approx(-0.176 * instance.get("F_n")[0] * 3.0 / 6e-6, rel=1e-7)


VARIABLES = {variable.name: variable for variable in read().modelVariables}
LAWS = tuple(int(item.value) for item in VARIABLES["friction.model"].declaredType.items)
COULOMB = 2
TUNABLE = tuple(name for name, variable in VARIABLES.items() if variable.variability == "tunable")
STATES = ("delta", "W_f", "Q_f", "delta_y")
RATES = tuple(f"der({name})" for name in STATES)


def drawn(number: int) -> tuple[dict[str, int], dict[str, float], float]:
    """Enumerations and values of a seeded scene, and a time after its start."""
    rng = np.random.default_rng([62, number])

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** rng.random())

    law = LAWS[number % len(LAWS)]
    choices = {
        "friction.model": law,
        "friction.limit": int(rng.integers(1, 3)),
        "contact.model": int(rng.integers(1, 4)),
        "contact.input": int(rng.integers(1, 3)),
    }
    stiffness, V_1 = between(1e6, 1e9), between(1e-2, 1.0)
    across = number // len(LAWS) % 2
    reach = between(0.2, 0.9) * 20.0 / stiffness  # within the least bound
    values = {"V": float(rng.choice([-1.0, 1.0])) * between(1e-2, 2.0), "V_y": across * between(1e-2, 1.0)}
    values |= {"d": 14e-6 * between(0.9, 1.1), "E": 58e9 * between(0.5, 2.0)}
    values |= {
        "load": 312.0 * between(0.7, 1.4),
        "F_C": between(30.0, 90.0),
        "friction.mu": between(0.12, 0.3),
    }
    values |= {"friction.staticRatio": 1.0 + between(0.1, 1.0), "friction.V_S": between(0.1, 1.0)}
    values |= {"friction.sigma_1": between(0.1, 10.0), "friction.sigma_2": between(0.1, 10.0)}
    scale = between(0.5, 2.0) * (1e-6 if choices["contact.model"] == 1 else 1e-3)
    values |= {"contact.sigma": stiffness, "contact.stiffnessScale": scale, "vibration.f": between(1e4, 4e4)}
    values |= {"vibration.V_1": V_1, "vibration.V_2": across * V_1 * between(0.1, 1.0)}
    values |= {"vibration.a_d": between(1e-7, 2e-6)}
    values |= {f"vibration.phase_{which}": float(rng.uniform(-3.0, 3.0)) for which in "d2"}
    values |= {"delta_0": reach, "delta_y_0": across * reach * float(rng.uniform(-0.5, 0.5))}
    lacking = set(TUNABLE) - values.keys()
    assert not lacking, f"drawn gives no value to {lacking}"
    return choices, values, between(1e-6, 1e-4)


def scale_of(name: str, values: dict[str, float]) -> float:
    """The change of a variable with which the contact becomes another one, within its bounds."""
    if "phase" in name:
        return 1.0
    if name in ("W_f", "Q_f", "d"):
        return 2e-6 if name == "d" else 1e-3  # m, R_q over lambda; J
    if name == "vibration.a_d":
        return min(2e-6, values[name])  # m, R_q over lambda
    if name in ("vibration.f", "time"):
        return 5e2 if name == "vibration.f" else 1e-5  # Hz, s, which turn the phase by some tenths
    if name == "friction.staticRatio":
        return values[name] - 1.0
    return min(values["friction.V_S"], abs(values[name])) if name[0] == "V" or "V_" in name else values[name]


def by_richardson(
    instance: Instance, name: str, step: float, unknown: Sequence[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Central differences of order 6, and whether they tell of a smooth function there."""
    start, *here = instance.get(name, *unknown)

    def at(x: float) -> np.ndarray:
        set_it = instance.call("fmi2SetTime", x) if name == "time" else instance.set({name: x})
        assert set_it == OK
        return np.array(instance.get(*unknown))

    steps = np.array([[step], [step / 2], [step / 4]])
    above, below = (np.array([at(start + side * h) for h in steps.ravel()]) for side in (1, -1))
    at(start)
    first = (above - below) / (2 * steps)
    second = (4 * first[1:] - first[:-1]) / 3
    sixth = (16 * second[1] - second[0]) / 15
    bend = np.abs(above + below - 2 * np.array(here)) / steps  # goes with the step, but at a kink
    rounding = 1e-11 * (np.abs(here) / step + np.abs(sixth))
    smooth = (bend[2] <= 0.4 * bend[0] + 1e-9 * np.abs(sixth) + rounding) & (
        np.abs(sixth - second[1]) <= 1e-6 * np.abs(sixth) + rounding
    )
    return sixth, smooth


def prepared(
    new_instance: Callable[..., Instance], kind: int, number: int
) -> tuple[Instance, dict[str, float]]:
    """After a step of co-simulation; in model exchange at some time, slipping in a third of the scenes."""
    choices, values, t = drawn(number)
    slips = {"delta_0": 1e-3} if kind == MODEL_EXCHANGE and number % 3 == 0 else {}
    state = "step complete" if kind == CO_SIMULATION else "continuous-time mode"
    instance = new_instance(kind=kind).start(choices, values | slips, state)
    moved = instance.step(0.0, t) if kind == CO_SIMULATION else instance.call("fmi2SetTime", t)
    assert moved == OK
    return instance, values


@pytest.mark.parametrize("part", range(8))
@pytest.mark.parametrize("kind", [CO_SIMULATION, MODEL_EXCHANGE])
def test_every_derivative(new_instance: Callable[..., Instance], kind: int, part: int) -> None:
    """Eight digits, of the derivative or of the output over the variable's scale.

    By inputs and tunable parameters; in model exchange by states and time too.
    """
    of_step = {*STATES, "F_t_mean", "F_y_mean", "body.v", "body.x"} if kind == CO_SIMULATION else set()
    unknown = tuple(name for name in (*OUTPUTS, *RATES) if name not in of_step)
    known = (*STEPS, *TUNABLE, *((*STATES, "time") if kind == MODEL_EXCHANGE else ()))
    asked = graded = 0
    for number in range(25 * part, 25 * part + 25):
        if kind == MODEL_EXCHANGE and LAWS[number % len(LAWS)] == COULOMB:
            continue  # Coulomb is refused there
        instance, values = prepared(new_instance, kind, number)
        here = np.abs(instance.get(*unknown))
        # A relaxed bristle moves by what V and the relaxation leave, with the rounding of V: some eps, times
        # 800 in a difference over 1/800 of the scale.
        speed = sum(abs(values[name]) for name in ("V", "V_y", "vibration.V_1", "vibration.V_2"))
        here[[name.startswith("der(delta") for name in unknown]] += 1e-4 * speed
        if kind == MODEL_EXCHANGE:
            values |= dict(zip(STATES, np.abs(instance.states()), strict=True))
        for name in known:
            if values.get(name) == 0.0 and name not in ("W_f", "Q_f"):
                continue  # at its bound
            scale = scale_of(name, values)
            status, exact = instance.directional(unknown, {name: 1.0})
            assert status == OK, instance.messages
            expected, smooth = by_richardson(instance, name, 0.005 * scale, unknown)
            error = np.abs(np.array(exact) - expected) / (np.abs(expected) + here / scale + 1e-300)
            asked, graded = asked + len(unknown), graded + int(smooth.sum())
            wrong = smooth & (error > 1e-8)
            assert not wrong.any(), (number, name, np.array(unknown)[wrong], error[wrong])
        instance.free()
    assert graded > 0.9 * asked


@pytest.mark.parametrize("number", range(8))
def test_of_the_settled_force(instance: Instance, number: int) -> None:
    """Eight digits again, of every law along a line and in the plane."""
    choices, values, _ = drawn(number)
    if choices == {**choices, **ELASTIC_PLASTIC}:
        values["friction.staticRatio"] = 1.0  # else it takes long
    instance.start(choices, values | {"solver.tolerance": 1e-12})
    here, asked = np.hypot(*instance.get(*SETTLED)), 0
    for name in (*STEPS, *TUNABLE):
        scale = scale_of(name, values) if values.get(name) else 0.0
        if scale == 0.0:
            continue  # at its bound
        status, exact = instance.directional(SETTLED, {name: 1.0})
        assert status == OK, instance.messages
        expected, smooth = by_richardson(instance, name, 0.005 * scale, SETTLED)
        error = np.abs(np.array(exact) - expected) / (np.abs(expected) + here / scale)
        assert not (smooth & (error > 1e-8)).any(), (name, error)
        asked += smooth.all()
    assert asked > 12


def declared() -> list[tuple[str, str]]:
    """Each output or rate of ModelStructure, and what it depends on there."""
    model = read()
    return [
        (unknown.variable.name, known.name)
        for unknown in (*model.outputs, *model.derivatives)
        for known in unknown.dependencies
    ]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", [CO_SIMULATION, MODEL_EXCHANGE], ids=["co-simulation", "model exchange"])
def test_all_declared_dependencies_are_answered(
    new_instance: Callable[..., Instance], kind: int, law: int
) -> None:
    if kind == MODEL_EXCHANGE and law == COULOMB:
        pytest.skip("model exchange has no Coulomb")
    state = "step complete" if kind == CO_SIMULATION else "continuous-time mode"
    instance = new_instance(kind=kind).start({"friction.model": law}, {"V_y": 0.1}, state)
    assert {"F_t", "F_n", "der(delta)"} <= {unknown for unknown, _ in declared()}
    for unknown, known in declared():
        assert instance.directional([unknown], {known: 1.0})[0] == OK, (unknown, known)


@pytest.mark.parametrize("number", range(24))
def test_derivatives_by_states_in_co_simulation(new_instance: Callable[..., Instance], number: int) -> None:
    """Those of model exchange, graded above, by which a bristle beyond its bound has been moved onto it."""
    choices, values, _ = drawn(number)
    if choices["friction.model"] == COULOMB:
        pytest.skip("model exchange has no Coulomb")
    values |= {"delta_0": 1e-3} if number % 3 == 0 else {}
    step, exchange = (
        new_instance(kind=kind).start(choices, values, state)
        for kind, state in ((CO_SIMULATION, "step complete"), (MODEL_EXCHANGE, "continuous-time mode"))
    )
    before, after = (np.array(each.get("delta", "delta_y")) for each in (step, exchange))
    size = np.hypot(*before)
    tangent = {"delta": -before[1] / size, "delta_y": before[0] / size}
    unknown = [name for name in (*OUTPUTS, *RATES) if name not in STATES and not name.endswith("_mean")]
    status, found = step.directional(unknown, tangent)
    _, expected = exchange.directional(unknown, tangent)
    assert status == OK and any(expected)
    assert found == pytest.approx(np.array(expected) * np.hypot(*after) / size, rel=1e-12)
    for name in STATES:
        assert step.directional([*STATES, "F_t_mean"], {name: 1.0}) == (
            OK,
            [*(float(name == k) for k in STATES), 0.0],
        )


REFUSED = {
    "of the last step": ({}, {}, "step complete", "F_t_mean", "F_C", "F_t_mean has no derivative by F_C"),
    "the state after a step": ({}, {}, "step complete", "delta", "vibration.V_1", "delta has no derivative"),
    "the mass after a step": ({}, {"body.m": 1.0}, "step complete", "body.v", "F_C",
                              "body.v has no derivative"),
    "a settled start": ({"initialState": 2}, {}, "initialization", "F_t", "V", "initialState = Settled"),
    "a fixed parameter": ({}, {}, "step complete", "sigma", "contact.R_q", "contact.R_q .*is not an input"),
    "static friction that begins": (ELASTIC_PLASTIC, {}, "step complete", "F_t", "friction.staticRatio",
                                    "friction.staticRatio = 1"),
    "Coulomb at rest": ({"friction.model": 2}, {"V": 0.0}, "step complete", "F_t", "V", "does not exist"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_derivative_is_refused(new_instance: Callable[..., Instance], case: str) -> None:
    choices, values, state, unknown, known, reason = REFUSED[case]
    instance = new_instance(logging_on=True).start(choices, values, state)
    before = instance.fingerprint()
    assert instance.directional([unknown], {known: 1.0})[0] == ERROR
    assert re.search(reason, instance.last_message.text)
    assert instance.fingerprint() == before
