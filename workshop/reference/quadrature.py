"""The integrating factor, by Gauss quadrature between reversals.

    delta(t) = e^-G(w,t) delta(w) + integral_w^t e^-G(s,t) V(s) ds,      G(s,t) = integral_s^t sigma |V| / g

For every node t of every piece of the mesh, w is the start of the piece or, where that is long forgotten, a
time with G(w,t) large enough that e^-G vanishes. No equation is stepped or solved: stiffness only narrows the
window.
Impulse, work and heat are quadratures over the nodes:

    F_t = sigma delta + sigma_1 delta' + sigma_2 V,    dW = F_t V dt,    dQ = dW - sigma delta delta' dt
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from workshop.reference.arithmetic import Arithmetic, gauss_arrays
from workshop.reference.mesh import graded_mesh
from workshop.reference.scene import Drive, Scene


@dataclass(frozen=True)
class AffineMap:
    """delta_1 = (1 - relaxation) delta_0 + offset; impulse and work affine in delta_0, heat quadratic."""

    relaxation: Any
    offset: Any
    impulse_slope: Any
    impulse_offset: Any
    work_slope: Any
    work_offset: Any
    heat_square: Any
    heat_slope: Any
    heat_offset: Any

    @classmethod
    def identity(cls, zero: Any) -> AffineMap:
        return cls(*([zero] * 9))

    def then(self, next_: AffineMap) -> AffineMap:
        keep, add = 1 - self.relaxation, self.offset
        return AffineMap(
            relaxation=self.relaxation + keep * next_.relaxation,
            offset=add - next_.relaxation * add + next_.offset,
            impulse_slope=self.impulse_slope + next_.impulse_slope * keep,
            impulse_offset=self.impulse_offset + next_.impulse_slope * add + next_.impulse_offset,
            work_slope=self.work_slope + next_.work_slope * keep,
            work_offset=self.work_offset + next_.work_slope * add + next_.work_offset,
            heat_square=self.heat_square + next_.heat_square * keep * keep,
            heat_slope=self.heat_slope + next_.heat_slope * keep + 2 * next_.heat_square * keep * add,
            heat_offset=self.heat_offset
            + (next_.heat_square * add + next_.heat_slope) * add
            + next_.heat_offset,
        )

    def power(self, n: int) -> AffineMap:
        """n of these, one after the other."""
        result, square = AffineMap.identity(0 * self.relaxation), self
        while n:
            if n & 1:
                result = result.then(square)
            square = square.then(square)
            n >>= 1
        return result

    def apply(self, delta_0: Any) -> tuple[Any, Any, Any, Any]:
        """Deflection at the end, impulse, work, heat."""
        return (
            delta_0 - self.relaxation * delta_0 + self.offset,
            self.impulse_slope * delta_0 + self.impulse_offset,
            self.work_slope * delta_0 + self.work_offset,
            (self.heat_square * delta_0 + self.heat_slope) * delta_0 + self.heat_offset,
        )


def interval_map(scene: Scene, t0: Any, h: Any, arithmetic: Arithmetic, ratio: float = 2.0) -> AffineMap:
    """The affine map of [t0, t0 + h] for Dahl and LuGre without a bound."""
    mesh = arithmetic.array(graded_mesh(scene, t0, h, ratio))
    total = AffineMap.identity(arithmetic.real(0))
    for piece in piece_maps(Drive(scene, t0, arithmetic), mesh):
        total = total.then(piece)
    return total


def piece_maps(drive: Drive, mesh: np.ndarray) -> Iterator[AffineMap]:
    """The maps of the mesh's pieces, of a bristle that meets no bound in them."""
    block = 400  # pieces at a time, to bound memory
    for first in range(0, len(mesh) - 1, block):
        yield from _block_of_maps(drive, mesh[first : first + block + 1], drive.arithmetic)


def _block_of_maps(drive: Drive, mesh: np.ndarray, arithmetic: Arithmetic) -> list[AffineMap]:
    rule = gauss_arrays(arithmetic.nodes, arithmetic)
    x, weights = rule.nodes, rule.weights
    begin, size = mesh[:-1, None], (mesh[1:] - mesh[:-1])[:, None]
    inner = begin + size * x[None, :]
    rate = drive.relaxation_rate(inner)
    exponent = size * (rate @ rule.from_start.T)
    # the end of the piece is treated as one more node
    times = np.concatenate([inner, mesh[1:, None]], axis=1)
    exponent = np.concatenate([exponent, size * (rate @ weights)[:, None]], axis=1)
    starts = np.broadcast_to(begin, times.shape)
    relaxation, offset = _deflection(drive, starts, times, exponent, arithmetic)
    sigma, V = drive.sigma(inner), drive.V(inner)
    keep, add = 1 - relaxation[:, :-1], offset[:, :-1]
    # F_t = slope delta + damping V at every node
    slope, damping = sigma - drive.sigma_1 * rate, drive.sigma_1 + drive.sigma_2
    time = weights * size
    work, heat = time * V, time * rate
    return [
        AffineMap(*values)
        for values in zip(
            relaxation[:, -1],
            offset[:, -1],
            (time * slope * keep).sum(axis=1),
            (time * (slope * add + damping * V)).sum(axis=1),
            (work * slope * keep).sum(axis=1),
            (work * (slope * add + damping * V)).sum(axis=1),
            (heat * sigma * keep * keep).sum(axis=1),
            (heat * (2 * sigma * add - drive.sigma_1 * V) * keep).sum(axis=1),
            (heat * (sigma * add - drive.sigma_1 * V) * add + work * damping * V).sum(axis=1),
            strict=True,
        )
    ]


def _deflection(
    drive: Drive, starts: np.ndarray, times: np.ndarray, exponent: np.ndarray, arithmetic: Arithmetic
) -> tuple[np.ndarray, np.ndarray]:
    """1 - P and Q of delta(time) = P delta(start) + Q, elementwise."""
    shape = times.shape
    starts, times, exponent = starts.ravel(), times.ravel(), exponent.ravel()
    from_start = exponent <= arithmetic.real(1.4 * arithmetic.window)
    length = times - starts
    remembered = np.where(from_start, exponent, arithmetic.real(1))
    relaxation = np.where(from_start, -arithmetic.expm1(-remembered), arithmetic.real(1))
    forgotten = np.flatnonzero(~from_start)
    if forgotten.size:
        length[forgotten] = _window_length(drive, times[forgotten], length[forgotten], arithmetic)
    rule = gauss_arrays(arithmetic.window_nodes, arithmetic)
    x, weights = rule.nodes, rule.weights
    inner = times[:, None] - length[:, None] * (1 - x)
    decay = length[:, None] * (drive.relaxation_rate(inner) @ rule.to_end.T)
    offset = length * ((arithmetic.exp(-decay) * drive.V(inner)) @ weights)
    return relaxation.reshape(shape), offset.reshape(shape)


def _window_length(
    drive: Drive, times: np.ndarray, longest: np.ndarray, arithmetic: Arithmetic
) -> np.ndarray:
    """L <= longest with G(time - L, time) near the window's exponent."""
    rule = gauss_arrays(8, arithmetic)
    x, weights = rule.nodes, rule.weights
    wanted = arithmetic.real(arithmetic.window)
    length = longest.copy()
    for _ in range(200):
        inner = times[:, None] - length[:, None] * (1 - x)
        exponent = length * (drive.relaxation_rate(inner) @ weights)
        long, short = exponent > 1.3 * wanted, (exponent < 0.95 * wanted) & (length < longest)
        if not (long | short).any():
            return length
        scale = np.where(long | short, wanted / exponent, 1 + 0 * exponent)
        length = np.minimum(length * np.clip(scale, arithmetic.real(1e-3), arithmetic.real(2)), longest)
    raise ArithmeticError("no window found for the integrating factor")
