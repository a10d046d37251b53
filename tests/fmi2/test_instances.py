"""Many instances in one process: instantiation, independence, threads."""

from __future__ import annotations

import random
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import pytest
from bad_calls import INSTANTIATIONS
from fmi_library import CO_SIMULATION, OK, Instance, Library

OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")


@pytest.mark.parametrize("case", INSTANTIATIONS)
def test_refused_instantiation(library: Library, case: str) -> None:
    arguments, told = INSTANTIATIONS[case]
    refused = Instance(library, **arguments)
    assert refused.component is None
    assert len(refused.messages) == 1
    assert refused.last_message.category == "logStatusError"
    assert told in refused.last_message.text


def test_no_guid_and_no_callbacks(library: Library) -> None:
    instantiate = library.dll.fmi2Instantiate
    assert instantiate(b"contact", CO_SIMULATION, library.guid.encode(), None, None, 0, 0) is None
    instance = Instance(library)
    assert instantiate(b"contact", CO_SIMULATION, None, None, instance._callbacks, 0, 0) is None
    assert "the guid is missing" in instance.last_message.text
    instance.free()


@pytest.mark.parametrize(
    "text", ["file:///a%20b/resources", "C:\\nonsense µ", "with % and #" + "n" * 100_000]
)
def test_any_name_and_resource_location(new_instance: Callable[..., Instance], text: str) -> None:
    instance = new_instance(name=text, resource_location=text)
    instance.step(0.0, 1.0)
    assert instance.last_message.name == text
    instance.initialize()
    assert instance.step(0.0, 1e-5) == OK


def run(instance: Instance, number: int, steps: int) -> list[float]:
    chance = random.Random(number)
    V = chance.uniform(-0.5, 0.5)
    values = {"V": V, "d": chance.uniform(13e-6, 17e-6), "F_C": chance.uniform(10, 100)}
    values |= {"contact.stiffnessScale": 10 ** chance.uniform(-6, 0)}
    values |= {"vibration.V_1": chance.choice([0.0, 0.3]), "vibration.a_d": chance.choice([0.0, 1e-6])}
    instance.start(values=values)
    for step in range(steps):
        if step % 5 == 4:
            instance.step(-1.0, 1e-5)  # refused, with a message
        assert instance.set({"V": V + 0.01 * step}) == OK
        assert instance.step(step * 1.7e-5, 1.7e-5) == OK, instance.messages
    return instance.get(*OUTPUTS)


def test_instances_in_threads(library: Library) -> None:
    """Forty contacts that live at once give what each gives alone."""

    def one(number: int) -> list[float]:
        with Instance(library, name=f"contact {number}", logging_on=True) as instance:
            results = run(instance, number, 20)
            assert all(message.name == f"contact {number}" for message in instance.messages)
            return results

    alone = [one(number) for number in range(40)]
    with ThreadPoolExecutor(max_workers=16) as threads:
        assert list(threads.map(one, range(40))) == alone
