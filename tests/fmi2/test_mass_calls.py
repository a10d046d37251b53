"""A mass inside: its interface in FMI 2.0. tests/physics/test_mass.py has its motion."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fmi_library import ERROR, MODEL_EXCHANGE, OK, WARNING, Instance

DAHL, COULOMB, ELASTIC_PLASTIC, LUGRE = range(1, 5)
CONTACT = {"contact.model": 2}
VALUES = {"V": 0.0, "contact.sigma": 6e6, "body.m": 0.5, "body.F": 70.0}
OUTPUTS = ("F_t", "F_t_mean", "body.v", "body.x", "W_f", "Q_f", "delta", "solver.evaluations")
STICKING = {"friction.staticRatio": 1.4, "friction.V_S": 0.02, "friction.sigma_1": 90.0}


METHODS = {"collocation": 1, "cvode": 2}


@pytest.fixture
def with_mass(new_instance: Callable[..., Instance]) -> Callable[..., Instance]:
    """An instance with a mass that has been initialized; skipped where cvode is asked for and absent."""

    def start(
        law: int = DAHL,
        values: dict[str, float] | None = None,
        kind: str = "step complete",
        method: int = 1,
    ) -> Instance:
        instance = new_instance()
        assert instance.choose(CONTACT | {"friction.model": law, "solver.method": method}) == OK
        assert instance.set(VALUES | (values or {})) == OK, instance.messages
        assert instance.call("fmi2EnterInitializationMode") == OK
        if kind == "initialization":
            return instance
        if instance.call("fmi2ExitInitializationMode") != OK:
            assert method == METHODS["cvode"] and "SUNDIALS" in instance.last_message.text
            pytest.skip("this build has no cvode, and says so")
        return instance

    return start


def run(instance: Instance, first: int, last: int, h: float = 1e-4) -> list[list[float]]:
    rows = []
    for step in range(first, last):
        assert instance.set({"V": 0.02 * (step % 3), "body.F": 90.0 - 40.0 * (step % 4)}) == OK
        if step % 4 == 1:
            assert instance.set_input_rates({"V": 30.0, "body.F": -4e5}) == OK
        assert instance.step(step * h, h) == OK, instance.messages
        rows.append(instance.get(*OUTPUTS))
    return rows


@pytest.mark.parametrize("law", [DAHL, COULOMB, ELASTIC_PLASTIC, LUGRE])
@pytest.mark.parametrize("method", METHODS)
def test_replay_gives_the_same_bits(
    with_mass: Callable[..., Instance], new_instance: Callable[..., Instance], law: int, method: str
) -> None:
    """In the same instance in mid-ring, and from the bytes in another one without a mass."""
    values = dict(STICKING) if law in (ELASTIC_PLASTIC, LUGRE) else {}
    values |= {"vibration.V_1": 0.05 * (law == COULOMB), "body.x_0": 3.0}
    instance = with_mass(law, values, method=METHODS[method])
    run(instance, 0, 3)
    assert instance.set_input_rates({"body.F": 1e5}) == OK
    data, state = instance.fingerprint(), instance.save()
    first = run(instance, 3, 9)
    assert instance.restore(state) == OK and instance.drop(state) == OK
    assert run(instance, 3, 9) == first
    for place in ("instantiated", "step complete"):
        other = new_instance().start(state=place).become(data)
        assert other.fingerprint() == data
        assert run(other, 3, 9) == first


@pytest.mark.parametrize("method", METHODS)
def test_a_refused_step_changes_nothing(with_mass: Callable[..., Instance], method: str) -> None:
    stiff = {"contact.sigma": 6e12, "body.m": 1e-3, "body.F": 20.0}
    instance = with_mass(values=stiff, method=METHODS[method])
    assert instance.step(0.0, 1e-6) == OK
    before = instance.fingerprint()
    assert instance.step(1e-6, 1e-2) == ERROR
    told = instance.last_message.text  # sqrt(sigma/m)/2 pi, and 0.4 sqrt(sigma m)
    assert "body.m = 0.001 kg" in told and "1.233e+04 kHz" in told and "1.233e+05 cycles" in told
    assert "friction.sigma_1 to 3.1e+04 N s/m" in told and "Coulomb" in told
    assert instance.fingerprint() == before
    assert instance.step(1e-6, 1e-6) == OK


@pytest.mark.parametrize("law", [DAHL, COULOMB])
def test_the_start_follows_from_the_start_values(
    with_mass: Callable[..., Instance], new_instance: Callable[..., Instance], law: int
) -> None:
    start = {"body.v_0": -0.3, "body.x_0": 0.7, "V": 0.1, "friction.sigma_2": 5.0, "body.F": 0.0}
    instance = with_mass(law, start, "initialization")
    v, x, force, mean = instance.get("body.v", "body.x", "F_t", "F_t_mean")
    assert (v, x) == (-0.3, 0.7)
    assert force == mean == pytest.approx(5.0 * -0.2 - 55.0 * (law == COULOMB))
    assert instance.set({"body.v_0": 0.0, "body.m": 0.0}) == OK
    assert instance.get("body.v", "body.x") == [0.0, 0.0]
    assert instance.call("fmi2Reset") == OK
    assert instance.fingerprint() == new_instance().fingerprint()


REFUSED_AT_START = {
    "body.m = 0.5 kg with solver.method = 3": ({"solver.method": 3}, {}),
    "vibration.V_2 = 0.25 m/s must be 0 m/s": ({}, {"vibration.V_2": 0.25}),
    "delta_y_0 = 1e-09 m must be 0 m": ({}, {"delta_y_0": 1e-9}),
    "V_y = -0.5 m/s must be 0 m/s": ({}, {"V_y": -0.5}),
}


@pytest.mark.parametrize("text", REFUSED_AT_START)
def test_what_a_mass_cannot_have_is_refused(instance: Instance, text: str) -> None:
    choices, values = REFUSED_AT_START[text]
    assert instance.choose(CONTACT | {"friction.model": COULOMB} | choices) == OK
    assert instance.set(VALUES | values) == OK
    assert instance.call("fmi2EnterInitializationMode") == OK
    assert instance.call("fmi2ExitInitializationMode") == ERROR
    assert text in instance.last_message.text and "0.5 kg" in instance.last_message.text
    assert instance.set({"body.m": 0.0}) == OK
    assert instance.call("fmi2ExitInitializationMode") == OK, instance.messages


def test_transverse_motion_is_refused_in_a_step(with_mass: Callable[..., Instance]) -> None:
    instance = with_mass(COULOMB)
    assert instance.set_input_rates({"V_y": 2.0}) == OK
    assert instance.step(0.0, 1e-4) == ERROR
    assert "the derivative of V_y = 2 m/s2 must be 0 m/s2" in instance.last_message.text
    assert instance.set_input_rates({"V_y": 0.0}) == OK
    assert instance.set({"V_y": 0.1}) == OK
    assert instance.step(0.0, 1e-4) == ERROR
    assert "V_y = 0.1 m/s must be 0 m/s with body.m = 0.5 kg" in instance.last_message.text
    assert instance.set({"V_y": 0.0}) == OK
    assert instance.step(0.0, 1e-4) == OK


@pytest.mark.parametrize(
    ("value", "text"), [(-1.0, "below its minimum 0 kg"), (float("nan"), "not a finite")]
)
def test_a_mass_has_a_bound(instance: Instance, value: float, text: str) -> None:
    assert instance.set({"body.m": value}) == ERROR
    assert text in instance.last_message.text and "body.m" in instance.last_message.text


def test_model_exchange_refuses_a_mass(new_instance: Callable[..., Instance]) -> None:
    instance = new_instance(kind=MODEL_EXCHANGE)
    assert instance.choose(CONTACT) == OK and instance.set(VALUES) == OK
    assert instance.call("fmi2EnterInitializationMode") == OK
    assert instance.call("fmi2ExitInitializationMode") == ERROR
    assert "body.m = 0.5 kg must be 0 kg in model exchange" in instance.last_message.text
    assert instance.set({"body.m": 0.0}) == OK
    assert instance.call("fmi2ExitInitializationMode") == OK


MOVING = {
    "Dahl": (DAHL, {"friction.sigma_1": 40.0, "friction.sigma_2": 3.0}),
    "LuGre": (LUGRE, {"friction.staticRatio": 1.4, "friction.V_S": 0.02, "friction.sigma_1": 40.0}),
    "ElasticPlastic that sticks": (ELASTIC_PLASTIC, {"body.F": 20.0, "friction.sigma_1": 40.0}),
    "ElasticPlastic that slips": (ELASTIC_PLASTIC, STICKING | {"body.v_0": 0.005}),
    "Coulomb that sticks": (COULOMB, {"body.F": 20.0}),
    "Coulomb that slips": (COULOMB, {"body.v_0": 0.2, "friction.sigma_2": 3.0}),
}


@pytest.mark.parametrize("scene", MOVING)
def test_rates_of_outputs_are_those_of_a_short_step(with_mass: Callable[..., Instance], scene: str) -> None:
    law, values = MOVING[scene]
    instance = with_mass(law, values)
    assert instance.step(0.0, 1.3e-3) == OK
    assert instance.set_input_rates({"body.F": 2e3, "V": 0.0}) == OK
    names = ("F_t", "body.v", "body.x")
    rates = [instance.output_rate(name) for name in names]
    assert all(status == OK for status, _ in rates)
    before, h = instance.get(*names), 1e-7
    assert instance.step(1.3e-3, h) == OK
    for (_, rate), start, end, scale in zip(
        rates, before, instance.get(*names), (1e3, 1.0, 1e-3), strict=True
    ):
        assert (end - start) / h == pytest.approx(rate, rel=2e-3, abs=1e-3 * scale)


@pytest.mark.parametrize("scene", MOVING)
def test_derivatives_of_F_t_by_inputs(with_mass: Callable[..., Instance], scene: str) -> None:
    """By one-sided differences, extrapolated from two: a slower V leaves a bristle inside its kinetic bound.
    Where Coulomb's law sticks, any other V lets the mass slip, and is refused."""
    law, values = MOVING[scene]
    instance = with_mass(law, values)
    assert instance.step(0.0, 1.3e-3) == OK
    for name, small in {"V": 1e-7, "body.F": 1e-3}.items():
        status, (exact, of_v, of_x) = instance.directional(["F_t", "body.v", "body.x"], {name: 1.0})
        if scene == "Coulomb that sticks" and name == "V":
            assert status == ERROR
            continue
        assert (status, of_v, of_x) == (OK, 0.0, 0.0)
        value, here = instance.get(name, "F_t")
        slope = []
        for change in (small, 2.0 * small):
            assert instance.set({name: value + change}) == OK
            slope.append((instance.get("F_t")[0] - here) / change)
        assert instance.set({name: value}) == OK
        assert 2.0 * slope[0] - slope[1] == pytest.approx(exact, rel=1e-4, abs=1e-6), name


def test_the_settled_force_is_that_of_the_velocity_in_the_contact(with_mass: Callable[..., Instance]) -> None:
    vibrating = {"vibration.V_1": 0.4, "friction.sigma_2": 3.0}
    instance = with_mass(COULOMB, vibrating | {"body.v_0": 0.1, "V": 0.05})
    other = with_mass(COULOMB, vibrating | {"body.m": 0.0, "V": 0.15})
    assert instance.get("F_t_settled") == pytest.approx(other.get("F_t_settled"), rel=1e-12)
    assert instance.step(0.0, 1e-3) == OK
    v, settled = instance.get("body.v", "F_t_settled")
    assert v != 0.1 and other.set({"V": 0.05 + v}) == OK
    assert settled == pytest.approx(other.get("F_t_settled")[0], rel=1e-12)
    assert instance.directional(["F_t_settled"], {"body.F": 1.0}) == (OK, [0.0])
    exact = other.directional(["F_t_settled"], {"V": 1.0})[1]
    assert instance.directional(["F_t_settled"], {"V": 1.0}) == (OK, pytest.approx(exact, rel=1e-7))


def test_ringing_is_told_once(with_mass: Callable[..., Instance]) -> None:
    instance = with_mass(values={"body.m": 1e-3})
    for step in range(3):
        assert instance.step(step * 1e-3, 1e-3) == OK
    (told,) = [each for each in instance.messages if each.status == WARNING and "rings" in each.text]
    assert "F_t_mean" in told.text and "31 N.s/m for zeta = 0.2" in told.text
    quiet = with_mass(values={"body.m": 1e-3, "friction.sigma_1": 10.0})
    assert quiet.step(0.0, 1e-3) == OK and "rings" not in str(quiet.messages)


def test_a_force_without_a_mass_is_told_once(instance: Instance) -> None:
    instance.start(CONTACT, {"body.F": 1.0})
    for step in range(2):
        assert instance.step(step * 1e-6, 1e-6) == OK
    (told,) = [each for each in instance.messages if each.status == WARNING and "body.F" in each.text]
    assert "body.F = 1 N has no effect: body.m = 0" in told.text
