"""Pieces of time on which the deflection is smooth: none holds a reversal, and they shrink toward each layer.

A layer lies after the start, on both sides of every reversal and dip of |V|, and of times that are asked for.
Pieces grow geometrically from it; the smallest relaxes by e^-0.1 at most. The end is treated like one: a
reversal may lie just beyond.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION
from workshop.reference.scene import Drive, Scene, events


def graded_mesh(scene: Scene, t0: Any, h: Any, ratio: float = 2.0, layers: Iterable[Any] = ()) -> list:
    """Increasing local times from 0 to h, in multiprecision; near a layer neighbours differ by ratio."""
    drive, quick = Drive(scene, t0, MULTIPRECISION), Drive(scene, t0, EXTENDED)
    layers = [MP.mpf(0), *sorted([*events(drive, h), *load_halvings(drive, h), *layers]), h]
    times = [MP.mpf(0)]
    for left, right in zip(layers[:-1], layers[1:], strict=True):
        if right - left <= MP.mpf(10) ** (8 - MP.dps) * (right + abs(left)):
            continue
        middle = (left + right) / 2
        pieces = _from_layer(quick, left, middle, ratio)
        pieces += _from_layer(quick, right, middle, ratio)[-2::-1] + [right]
        longest = longest_piece(scene, drive, left, right)
        for end in pieces:
            count = int(MP.ceil((end - times[-1]) / longest))
            begin = times[-1]
            times += [begin + (end - begin) * (k + 1) / count for k in range(count)]
    times[-1] = h
    if drive.excess != 0:
        times = _resolve_stribeck_velocity(quick, times)
    return times


def load_halvings(drive: Drive, h: Any) -> list:
    """Local times in (0, h) at which a linear load is a half, a quarter ... of its largest value."""
    if drive.scene.input != "Load" or drive.load_rate == 0:
        return []
    ends = drive.load(MP.mpf(0)), drive.load(MP.mpf(h))
    load, times = max(ends) / 2, []
    while load > min(ends):
        times.append((load - drive.load_0) / drive.load_rate)
        load /= 2
    return sorted(time for time in times if 0 < time < h)


def _resolve_stribeck_velocity(drive: Drive, times: list) -> list:
    """Where e^-(V/V_S)^2 is not negligible, V changes by V_S at most in one piece."""
    edges = drive.arithmetic.array(times)
    quarters = np.arange(5, dtype=edges.dtype) / 4
    V = drive.V(edges[:-1, None] + np.diff(edges)[:, None] * quarters)
    steepest = 5 * abs(np.diff(V)).max(axis=1)
    counts = np.where(abs(V).min(axis=1) < 10 * drive.V_S, np.ceil(steepest / drive.V_S), 1)
    resolved = times[:1]
    for begin, end, count in zip(
        times[:-1], times[1:], np.maximum(counts, 1).astype(int).tolist(), strict=True
    ):
        resolved += [begin + (end - begin) * (k + 1) / count for k in range(count)]
    return resolved


def _from_layer(drive: Drive, layer: Any, far: Any, ratio: float) -> list:
    """Ends of pieces from layer (not included) to far (included, last); far may lie on either side."""
    offsets, ratio = [far - layer], MP.mpf(ratio)
    start, size = drive.arithmetic.real(layer), drive.arithmetic.real(far - layer)
    quarters = np.arange(5, dtype=drive.arithmetic.dtype) / 4
    while drive.relaxation_rate(start + size * quarters).max() * abs(size) >= 0.1:
        offsets.append(offsets[-1] / ratio)
        size = drive.arithmetic.real(offsets[-1])
    return [layer + offset for offset in reversed(offsets)]


def longest_piece(scene: Scene, drive: Drive, left: Any, right: Any) -> Any:
    """Pieces over which V, ln sigma and d change by a moderate factor."""
    longest = right - left
    if scene.vibrates:
        longest = min(longest, scene.period / 16)
    if scene.contact.model != "Constant" or scene.limit == "Load":
        steepness = 2 * drive.decay + 3 / min(drive.d(left), drive.d(right))
        speed = abs(drive.d_rate) + abs(drive.a_d) * drive.omega
        if speed > 0:
            longest = min(longest, 2 / (steepness * speed))
        if drive.E_rate != 0:
            longest = min(longest, min(drive.E(left), drive.E(right)) / (4 * abs(drive.E_rate)))
        if scene.input == "Load" and drive.load_rate != 0:
            longest = min(longest, min(drive.load(left), drive.load(right)) / (4 * abs(drive.load_rate)))
    return longest
