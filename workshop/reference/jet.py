"""Jets: a function of time with its first two derivatives, carried through every operation."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from workshop.reference.arithmetic import EXTENDED


class Jet:
    """value, first and second derivative: numbers or arrays of one shape."""

    __array_ufunc__ = None  # numpy leaves mixed operations to this class

    def __init__(self, value: Any, first: Any = 0, second: Any = 0) -> None:
        self.value, self.first, self.second = value, first, second

    def __add__(self, other: Any) -> Jet:
        other = _jet(other)
        return Jet(self.value + other.value, self.first + other.first, self.second + other.second)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.first, -self.second)

    def __abs__(self) -> Jet:
        return self * np.sign(self.value)

    def __sub__(self, other: Any) -> Jet:
        return self + (-_jet(other))

    def __rsub__(self, other: Any) -> Jet:
        return -self + other

    def __mul__(self, other: Any) -> Jet:
        other = _jet(other)
        return Jet(
            self.value * other.value,
            self.first * other.value + self.value * other.first,
            self.second * other.value + 2 * self.first * other.first + self.value * other.second,
        )

    def __truediv__(self, other: Any) -> Jet:
        return self * _jet(other)._reciprocal()

    def __rtruediv__(self, other: Any) -> Jet:
        return self._reciprocal() * other

    __radd__ = __add__
    __rmul__ = __mul__

    def _reciprocal(self) -> Jet:
        inverse = 1 / self.value
        return self.compose(inverse, -inverse * inverse, 2 * inverse * inverse * inverse)

    def compose(self, value: Any, first: Any, second: Any) -> Jet:
        """F(self) from F, F' and F'' at the value."""
        return Jet(value, first * self.first, second * self.first * self.first + first * self.second)


def _jet(x: Any) -> Jet:
    return x if isinstance(x, Jet) else Jet(x)


def _exp(x: Any) -> Any:
    if not isinstance(x, Jet):
        return np.exp(x)
    value = np.exp(x.value)
    return x.compose(value, value, value)


def _cos(x: Any) -> Any:
    if not isinstance(x, Jet):
        return np.cos(x)
    value = np.cos(x.value)
    return x.compose(value, -np.sin(x.value), -value)


def _log(x: Any) -> Any:
    if not isinstance(x, Jet):
        return np.log(x)
    inverse = 1 / x.value
    return x.compose(np.log(x.value), inverse, -inverse * inverse)


JETS = replace(EXTENDED, name="jets", exp=_exp, cos=_cos, log=_log)


def at(times: Any) -> Jet:
    """The time itself as a jet."""
    one = 1 + 0 * times
    return Jet(times, one, 0 * one)
