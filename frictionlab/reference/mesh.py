"""Pieces of time on which the deflection is smooth: none holds a reversal, and they shrink toward each layer.

A layer lies after the start, and on both sides of every reversal and dip of |V|. Pieces grow geometrically
from it; the smallest relaxes by e^-0.1 at most. The end is treated like one: a reversal may lie just beyond.
"""

from __future__ import annotations

from typing import Any

from frictionlab.reference.arithmetic import MP, MULTIPRECISION
from frictionlab.reference.scene import Drive, Scene, events


def graded_mesh(scene: Scene, t0: Any, h: Any, ratio: float = 2.0) -> list:
    """Increasing local times from 0 to h, in multiprecision; near a layer neighbours differ by ratio."""
    drive = Drive(scene, t0, MULTIPRECISION)
    layers = [MP.mpf(0), *events(drive, h), h]
    times = [MP.mpf(0)]
    for left, right in zip(layers[:-1], layers[1:], strict=True):
        if right - left <= MP.mpf(10) ** (8 - MP.dps) * (right + abs(left)):
            continue
        middle = (left + right) / 2
        pieces = _from_layer(drive, left, middle, ratio)
        pieces += _from_layer(drive, right, middle, ratio)[-2::-1] + [right]
        longest = _longest_piece(scene, drive, left, right)
        for end in pieces:
            count = int(MP.ceil((end - times[-1]) / longest))
            begin = times[-1]
            times += [begin + (end - begin) * (k + 1) / count for k in range(count)]
    times[-1] = h
    return times


def _from_layer(drive: Drive, layer: Any, far: Any, ratio: float) -> list:
    """Ends of pieces from layer (not included) to far (included, last); far may lie on either side."""
    offsets = [far - layer]
    ratio = MP.mpf(ratio)
    while True:
        size = offsets[-1]
        rate = max(drive.relaxation_rate(layer + size * k / 4) for k in range(5))
        if rate * abs(size) < MP.mpf("0.1"):
            break
        offsets.append(size / ratio)
    return [layer + offset for offset in reversed(offsets)]


def _longest_piece(scene: Scene, drive: Drive, left: Any, right: Any) -> Any:
    """Pieces over which V, ln sigma and d change by a moderate factor."""
    longest = right - left
    if scene.vibrates:
        longest = min(longest, scene.period / 16)
    if scene.contact.model != "Constant":
        steepness = 2 * drive.decay + 3 / min(drive.d(left), drive.d(right))
        speed = abs(drive.d_rate) + abs(drive.a_d) * drive.omega
        if speed > 0:
            longest = min(longest, 2 / (steepness * speed))
        if drive.E_rate != 0:
            longest = min(longest, min(drive.E(left), drive.E(right)) / (4 * abs(drive.E_rate)))
    return longest
