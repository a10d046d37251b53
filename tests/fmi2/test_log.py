"""What reaches the host's logger, and what does not."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_char_p

import pytest
from fmi_library import ERROR, OK, Instance, Library


def switch(instance: Instance, on: bool, *categories: str) -> int:
    names = (c_char_p * len(categories))(*(category.encode() for category in categories))
    return instance.call("fmi2SetDebugLogging", int(on), len(categories), names)


def whole_life(instance: Instance) -> set[str]:
    """Categories of the messages of a run with an event, a warning, an error and a word from the solver."""
    assert instance.set({"vibration.V_1": 1.0}) == OK
    instance.initialize()
    assert instance.step(0.0, 1e-3) == OK
    assert instance.step(5.0, 1e-3) == ERROR
    assert instance.call("fmi2Terminate") == OK
    return {message.category for message in instance.messages}


def test_the_declared_categories_are_the_ones_used(
    library: Library, new_instance: Callable[..., Instance], capfd: pytest.CaptureFixture[str]
) -> None:
    """All with debug logging or if none is named, errors and warnings without. Nothing is printed."""
    every, least = set(library.log_categories), {"logStatusError", "logStatusWarning"}
    assert whole_life(new_instance(logging_on=True)) == every
    assert whole_life(new_instance(logging_on=False)) == least
    named, off, silent = new_instance(), new_instance(logging_on=True), new_instance(with_logger=False)
    assert switch(named, True) == OK and whole_life(named) == every
    off.messages.clear()
    assert switch(off, False) == OK and whole_life(off) == least
    assert silent.set({"F_C": -1.0}) == ERROR and not whole_life(silent)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("category", ["logEvents", "logSolver", "logStatusWarning", "logStatusError"])
def test_one_category_at_a_time_and_errors_always(instance: Instance, category: str) -> None:
    assert switch(instance, True, category) == OK
    assert whole_life(instance) == {category, "logStatusError"}


@pytest.mark.parametrize("initial", [1, 2], ids=["Given", "Settled"])
@pytest.mark.parametrize("ratio", [1.5, 1.0])
def test_a_chaotic_settled_state_is_told_once(instance: Instance, ratio: float, initial: int) -> None:
    """With k = 70 a break-away multiplies an error: 1e-9 of V moves the mean by more than 1e-4."""
    values = {"friction.staticRatio": ratio, "friction.V_S": 0.22, "V": 0.036, "vibration.V_1": 0.19}
    values |= {"contact.sigma": 5.2e5, "friction.mu": 0.262, "F_C": 82.0}
    instance.start({"friction.model": 3, "contact.model": 2, "initialState": initial}, values)
    means = []
    for part in range(4):
        assert instance.set({"V": 0.036 * (1.0 + 1e-9 * part)}) == OK
        means += instance.get("F_t_settled")
    told = [message for message in instance.messages if "chaotic" in message.text]
    assert len(told) == (ratio > 1.0) and all(each.category == "logStatusWarning" for each in told)
    assert (max(means) - min(means) > 1e-4 * means[0]) == (ratio > 1.0)


def test_an_unknown_category_switches_nothing(instance: Instance) -> None:
    assert switch(instance, True, "logEvents", "logNothing") == ERROR
    instance.messages.clear()
    instance.initialize()
    assert instance.messages == []


def test_text_is_finished_cut_and_safe_as_a_format(instance: Instance) -> None:
    assert switch(instance, True, "100%s #r0#") == ERROR
    assert instance.last_message.text == "fmi2SetDebugLogging: log category '100%%s ##r0##' is unknown"
    assert switch(instance, True, "x" * 100_000) == ERROR
    assert len(instance.last_message.text) < 512
