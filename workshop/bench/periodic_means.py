"""What gives the mean of F_t over a period of the periodic state, and what it costs.

    default           one step over a million periods, and one more whose F_t_mean it is
    harmonic balance  delta as a Fourier series, sigma |V| / F_C and V from samples in time (AFT); the
                      equation is affine, so Newton's method ends with one linear system of the coefficients
    closed form       constant sigma: the forces at the reversals exactly; between them F relaxes over the
                      path, whose mean is a Gauss quadrature
    Coulomb's limit   (2 / pi) asin(V / V_1), that of an infinite stiffness

Costs are evaluations of V and sigma, and time over the default's; all but the default run in numpy.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from rich.table import Table
from scipy.linalg import toeplitz

from frictioncontact.parameters import PERIOD, STIFFNESS_PRINTED
from workshop.bench.driver import Bench, Job
from workshop.reference import solution as reference
from workshop.reference.scene import Scene
from workshop.reference.start_values import scene_of

SCENES = {
    **{
        f"constant σ, κ = {kappa:g}": {
            "V": 0.3,
            "vibration.V_1": 1.0,
            "contact.model": "Constant",
            "contact.sigma": kappa * 2 * math.pi * 55.0 / PERIOD,
        }
        for kappa in (1.0, 100.0, 1e4)
    },
    "V and d vibrate, σ 6e6 N/m": {
        "V": 0.3,
        "vibration.V_1": 1.0,
        "vibration.a_d": 1.1e-6,
        "contact.stiffnessScale": 6e6 / STIFFNESS_PRINTED,
    },
}
ACCURACIES = (1e-3, 1e-6, 1e-9)  # over F_C
SAMPLES = tuple(2**k for k in range(4, 13))  # of a period
REPETITIONS = 5  # of which the shortest time counts
Result = tuple[float, float, float]  # mean [N], evaluations, time [s]


gauss = lru_cache(np.polynomial.legendre.leggauss)


def harmonic_balance(scene: Scene, still: float, samples: int) -> float:
    """The mean [N] with harmonics up to a quarter of the samples; still: sigma at scene.d [N/m]."""
    harmonics, omega = samples // 4, 2 * math.pi * scene.f
    theta = 2 * math.pi * np.arange(samples) / samples
    V = scene.V + scene.V_1 * np.cos(theta)
    sigma = np.full(samples, still)
    if scene.contact.model == "Asperities":
        swing = scene.a_d * np.cos(theta + scene.phase_d)
        decay = 2.0 * scene.contact.lambda_ / scene.contact.R_q
        sigma *= (1.0 + swing / scene.d) ** -3 * np.exp(-decay * swing)  # Eq. 3
    rate = np.fft.fft(sigma * np.abs(V) / scene.F_C) / samples
    matrix = toeplitz(rate[: 2 * harmonics + 1], rate[-np.arange(2 * harmonics + 1)])
    order = np.arange(-harmonics, harmonics + 1)
    matrix[np.diag_indices_from(matrix)] += 1j * omega * order
    spectrum = np.zeros(samples, complex)
    spectrum[order] = np.linalg.solve(matrix, (np.fft.fft(V) / samples)[order])
    return float(np.mean(sigma * np.fft.ifft(spectrum * samples).real))


def closed_form(scene: Scene, sigma: float, samples: int) -> float:
    """The mean [N] with half of the samples as Gauss nodes in each of the two stretches; 0 < V < V_1."""
    omega, D = 2 * math.pi * scene.f, scene.F_C / sigma
    turn = math.acos(-scene.V / scene.V_1)
    corners = (-turn, turn, 2 * math.pi - turn)

    def position(theta: np.ndarray | float) -> np.ndarray | float:
        return (scene.V * theta + scene.V_1 * np.sin(theta)) / omega

    keep = [math.exp(-abs(position(b) - position(a)) / D) for a, b in zip(corners, corners[1:], strict=False)]
    backward = (keep[1] * (2.0 - keep[0]) - 1.0) / (1.0 - keep[0] * keep[1])  # over F_C, where V turns up
    forward = 1.0 + (backward - 1.0) * keep[0]
    x, weights = gauss(samples // 2)
    total = 0.0
    for a, b, side, start in ((*corners[:2], 1.0, backward), (*corners[1:], -1.0, forward)):
        half = 0.5 * (b - a)
        path = np.abs(position(a + half * (1.0 + x)) - position(a))
        total += half * float(weights @ (side + (start - side) * np.exp(-path / D)))
    return scene.F_C * total / (2 * math.pi)


def default(bench: Bench, scene_values: dict, tolerance: float) -> Result:
    job = Job({**scene_values, "solver.tolerance": tolerance}, 1e6 * PERIOD, 2)
    outcomes = [bench.run(job) for _ in range(REPETITIONS)]
    return float(outcomes[0].F_mean[1]), 2 * outcomes[0].evaluations, 2 * min(o.cpu for o in outcomes)


def timed(mean: Callable[[Scene, float, int], float], scene: Scene, samples: int) -> Result:
    sigma, times = float(reference.sigma(replace(scene, a_d=0.0), 0)), []
    for _ in range(REPETITIONS):
        begin = time.perf_counter()
        value = mean(scene, sigma, samples)
        times.append(time.perf_counter() - begin)
    return value, samples, min(times)


def periodic_means(bench: Bench) -> list[dict[str, object]]:
    """For every scene and accuracy the evaluations of each method, and its time over the default's."""
    rows: list[dict[str, object]] = []
    for title, values in SCENES.items():
        scene = scene_of(values)
        right = float(reference.periodic_mean(scene))
        results = {
            "default": [default(bench, values, 10.0**-k) for k in range(2, 11)],
            "harmonic balance": [timed(harmonic_balance, scene, n) for n in SAMPLES],
        }
        if scene.contact.model == "Constant":
            results["closed form"] = [timed(closed_form, scene, n) for n in SAMPLES]
        limit = abs(scene.F_C * 2 / math.pi * math.asin(scene.V / scene.V_1) - right) / scene.F_C
        for accuracy in ACCURACIES:
            row: dict[str, object] = {"scene": title, "accuracy": accuracy, "Coulomb": limit}
            base = math.nan
            for method in ("default", "harmonic balance", "closed form"):
                found = results.get(method, [])
                good = [r for r in found if abs(r[0] - right) <= accuracy * scene.F_C]
                _, evaluations, seconds = good[0] if good else (0.0, math.nan, math.nan)
                base = seconds if method == "default" else base
                row |= {f"{method}: evaluations": evaluations, f"{method}: time": seconds / base}
            rows.append(row)
    return rows


def table(rows: Sequence[dict[str, object]]) -> Table:
    shown = Table(
        title="Periodic mean: evaluations, and in brackets time over the default's", title_justify="left"
    )
    methods = ("default", "harmonic balance", "closed form")
    for heading in ("scene", "error at most", *methods, "error of Coulomb's limit"):
        shown.add_column(heading)
    for row in rows:
        cells = []
        for method in methods:
            evaluations = float(str(row[f"{method}: evaluations"]))
            ratio = float(str(row[f"{method}: time"]))
            cells.append("-" if math.isnan(evaluations) else f"{evaluations:.0f} ({ratio:.3g})")
        shown.add_row(str(row["scene"]), f"{row['accuracy']:.0e}", *cells, f"{row['Coulomb']:.0e}")
    return shown
