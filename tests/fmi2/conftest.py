"""The library under test, and instances that are freed when a test ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fmi_library import Instance, Library


@pytest.fixture(scope="session")
def library(unzipped_fmu: Path) -> Library:
    return Library(Path(unzipped_fmu))


@pytest.fixture
def new_instance(library: Library) -> Iterator[Callable[..., Instance]]:
    instances: list[Instance] = []

    def instantiate(**arguments: Any) -> Instance:
        instances.append(Instance(library, **arguments))
        return instances[-1]

    yield instantiate
    for instance in instances:
        instance.free()


@pytest.fixture
def instance(new_instance: Callable[..., Instance]) -> Instance:
    return new_instance()
