"""A measured position without its scatter, which would turn a bristle to and fro where the motion is slow."""

import math

import numpy as np
from scipy.interpolate import make_smoothing_spline
from scipy.optimize import brentq

SMALL = (
    0.03  # of a step: a scatter that does not matter, and what the curve of an exact position may look like
)
MEDIAN = 0.6745  # of the size of normal noise with a standard deviation of 1


def scatter(time: np.ndarray, position: np.ndarray) -> float:
    """Standard deviation [m] of the noise: of four samples each, what no parabola explains."""
    times = np.stack([time[k : len(time) - 3 + k] for k in range(4)])
    positions = np.stack([position[k : len(time) - 3 + k] for k in range(4)])
    gaps = times[:, None] - times[None, :] + np.eye(4)[:, :, None]
    weights = 1.0 / np.prod(gaps, axis=1)
    miss = np.sum(weights * positions, axis=0) / np.sqrt(np.sum(weights**2, axis=0))
    return float(np.median(np.abs(miss))) / MEDIAN


def smoothed(time: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, float]:
    """The smoothest spline as far from the position as its scatter, and that [m], 0 if it is small."""
    noise = scatter(time, position) if len(time) > 8 else 0.0
    if noise <= SMALL * float(np.std(np.diff(position))):
        return position, 0.0
    place, height = (time - time[0]) / (time[-1] - time[0]), position / noise

    def curve(stiffness: float) -> np.ndarray:
        return make_smoothing_spline(place, height, lam=math.exp(stiffness))(place)

    def excess(stiffness: float) -> float:
        return float(np.mean((curve(stiffness) - height) ** 2)) - 1.0

    return noise * curve(brentq(excess, -60.0, 60.0, xtol=0.1)), noise
