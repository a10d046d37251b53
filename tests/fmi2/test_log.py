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
    library: Library, new_instance: Callable[..., Instance]
) -> None:
    assert whole_life(new_instance(logging_on=True)) == set(library.log_categories)


def test_without_debug_logging_only_errors_and_warnings(new_instance: Callable[..., Instance]) -> None:
    assert whole_life(new_instance(logging_on=False)) == {"logStatusError", "logStatusWarning"}


@pytest.mark.parametrize("category", ["logEvents", "logSolver", "logStatusWarning", "logStatusError"])
def test_one_category_at_a_time_and_errors_always(
    new_instance: Callable[..., Instance], category: str
) -> None:
    instance = new_instance()
    assert switch(instance, True, category) == OK
    assert whole_life(instance) == {category, "logStatusError"}


def test_no_category_means_all(library: Library, instance: Instance) -> None:
    assert switch(instance, True) == OK
    assert whole_life(instance) == set(library.log_categories)


def test_switching_off(new_instance: Callable[..., Instance]) -> None:
    instance = new_instance(logging_on=True)
    instance.messages.clear()
    assert switch(instance, False) == OK
    assert whole_life(instance) == {"logStatusError", "logStatusWarning"}


def test_an_unknown_category_switches_nothing(instance: Instance) -> None:
    assert switch(instance, True, "logEvents", "logNothing") == ERROR
    instance.messages.clear()
    instance.initialize()
    assert instance.messages == []


def test_text_is_finished_and_safe_as_a_format(instance: Instance) -> None:
    assert switch(instance, True, "100%s #r0#") == ERROR
    assert instance.last_message.text == "fmi2SetDebugLogging: log category '100%%s ##r0##' is unknown"


def test_long_text_from_the_host_is_cut(instance: Instance) -> None:
    assert switch(instance, True, "x" * 100_000) == ERROR
    assert len(instance.last_message.text) < 512


def test_an_instance_without_a_logger_works(
    new_instance: Callable[..., Instance], capfd: pytest.CaptureFixture[str]
) -> None:
    instance = new_instance(with_logger=False, logging_on=True)
    assert instance.set({"F_C": -1.0}) == ERROR
    whole_life(instance)
    assert capfd.readouterr() == ("", "")


def test_nothing_is_printed(new_instance: Callable[..., Instance], capfd: pytest.CaptureFixture[str]) -> None:
    whole_life(new_instance(logging_on=True))
    assert capfd.readouterr() == ("", "")
