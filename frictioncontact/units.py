"""Units as people write them, by pint, which is imported where a heading has a unit."""

from __future__ import annotations

import re
from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING, Any

from frictioncontact.errors import UserError, shown

if TYPE_CHECKING:
    from pint import UnitRegistry


def factor(unit: str, si: str, where: str) -> float:
    """From a unit to the SI unit of the same kind; UserError where it is of another kind, or no unit."""
    if unit == si:
        return 1.0
    given, wanted = _root(unit), _root(si)
    if given is None or given[1] != wanted[1]:
        raise UserError(f"{where} takes {f'a unit like {si}' if si != '1' else 'no unit'}, not {shown(unit)}")
    return given[0] / wanted[0]


def is_unit(text: str) -> bool:
    return _root(text) is not None


@cache
def _root(unit: str) -> Any:
    """Factor and unit in base units; None of what is no unit. rad/s is not Hz: radians stay."""
    powers = re.sub(r"(?<=[^\W\d])(-?\d)", r"**\1", unit)  # mm2, s-1
    with suppress(Exception):  # pint raises whatever its parser comes to
        return _registry().get_root_units(_registry().parse_units(powers))


@cache
def _registry() -> UnitRegistry:
    import pint

    registry: UnitRegistry = pint.UnitRegistry()
    registry.define("newton_second = newton * second = Ns")
    return registry
