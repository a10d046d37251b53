"""Fits the bound of a Gauss panel's error: prints the table BOUND of fmu_src/solver/panels/gauss_panel.c.

    .venv/bin/python -m workshop.constants.panel_bound

With the panel [-1, 1] in x, the bristle obeys delta' = V - r delta with

    V = mean + slope x + cos(alpha + phi x)    ln(sigma) = mu c(x) + constant    r = sigma |V| / g

whose integral is z; c is a cosine of phi x, or x itself, and g stands still, or goes as sigma, its root,
or its inverse. For each number of nodes n and each (phi, mu, z) of a grid, the error of the panel of n
nodes against one of 40 is taken over random phases, means, slopes and laws: of the deflection at the
end, over the least of 1 and z, of the mean force, the work and the heat; all for a bristle deflected by
1 and one that starts relaxed, in units of the force or of what it settles to. V keeps its sign in a
panel and is no less than half its largest value where it dips inside.

An error e is written as K = 2.94 n e^(1/2n): about the K for which n nodes miss cos(K x) by e. A linear
programme finds the least linear function of phi, phi mu, z and sqrt(z) that is nowhere below.
The solver calls phi mu mu.
tests/unit/test_bounded_panel.c holds the table against panels of other scenes.
"""

from collections.abc import Callable

import numpy as np
from numpy.polynomial import legendre
from scipy.optimize import linprog

DRAWS, EXACT = 800, 40
PHI = (0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.57, 2.0, 2.5, 3.14)
MU = (0, 0.1, 0.3, 0.7, 1.3, 2, 3, 5, 10, 30)  # over phi
Z = (1e-3, 0.01, 0.1, 0.3, 1, 2, 3, 5, 7)
Function = Callable[[np.ndarray], np.ndarray]
FITTED = (1e-13, 0.15)  # errors beyond are rounding, or too large to matter
GRID = np.linspace(-1, 1, 81)


class Rule:
    """Nodes x, weights and integrals up to each node, of means over [-1, 1]."""

    def __init__(self, n: int) -> None:
        self.x, weights = legendre.leggauss(n)
        self.weights = weights / 2
        values = legendre.legvander(self.x, n)
        coefficients = (np.arange(n) + 0.5)[:, None] * (values[:, :n] * weights[:, None]).T
        integrals = [self.x + 1]
        integrals += [(values[:, k + 1] - values[:, k - 1]) / (2 * k + 1) for k in range(1, n)]
        self.integral = np.column_stack(integrals) @ coefficients / 2


class Scenes:
    """Random phases, means and slopes of V, and laws; one row each."""

    def __init__(self, generator: np.random.Generator) -> None:
        def column(values: np.ndarray) -> np.ndarray:
            return values[:, None]

        quarter = generator.integers(0, 4, (2, DRAWS)) * np.pi / 2
        alpha, beta = np.where(
            generator.random(DRAWS) < 0.1, quarter, generator.uniform(0, 2 * np.pi, (2, DRAWS))
        )
        self.alpha, self.beta = column(alpha), column(beta)
        self.slope = column(np.where(generator.random(DRAWS) < 0.3, generator.uniform(-2, 2, DRAWS), 0))
        self.mean = column(generator.choice([0, 0.01, 0.1, 1, 10], DRAWS))  # above the least, in ranges of V
        self.straight = column(generator.random(DRAWS) < 0.1)  # V without vibration
        self.linear = column(generator.random(DRAWS) < 0.15)  # ln(sigma)
        self.sign = column(generator.choice([-1, 1], DRAWS))
        self.force = column(generator.random(DRAWS) < 0.8)  # sigma moves; else only g does
        self.power = np.where(self.force, column(generator.choice([1, 1, 0.5, 0], DRAWS)), -1)  # of sigma / g

    def V(self, phi: float) -> Function:
        def moving(x: np.ndarray) -> np.ndarray:
            turning = self.slope * phi * x + np.cos(self.alpha + phi * x)
            return np.where(self.straight, (1 + abs(self.slope)) * self.sign * x, turning)

        values = moving(GRID)
        least, spread = values.min(1, keepdims=True), np.ptp(values, 1, keepdims=True)
        above = self.mean * spread - least
        inside = values.argmin(1)[:, None]
        dips = (inside > 0) & (inside < GRID.size - 1)
        above = np.where(dips, np.maximum(above, 3 + 4 * abs(self.slope) * phi), above)
        return lambda x: moving(x) + above

    def log_sigma(self, phi: float, mu: float) -> Function:
        return lambda x: np.where(self.linear, phi * mu * self.sign * x, mu * np.cos(self.beta + phi * x))


def results(scenes: Scenes, rule: Rule, exact: Rule, phi: float, mu: float, z: float) -> np.ndarray:
    """What a panel gives of a deflected and of a relaxed bristle; shape (results, DRAWS)."""
    V, log_sigma = scenes.V(phi), scenes.log_sigma(phi, mu)
    level = log_sigma(GRID)
    top, bottom = level.max(1, keepdims=True), level.min(1, keepdims=True)

    def per_path(x: np.ndarray) -> np.ndarray:  # sigma / g
        return np.exp(scenes.power * (log_sigma(x) - np.where(scenes.power < 0, bottom, top)))

    def stiffness(x: np.ndarray) -> np.ndarray:
        return np.where(scenes.force, np.exp(log_sigma(x) - top), 1.0)

    x = rule.x
    path = np.maximum(V(exact.x) @ exact.weights, 1e-300)[:, None]
    relaxes = ((per_path(exact.x) * V(exact.x)) @ exact.weights)[:, None]
    speed, sigma = V(x) / path, stiffness(x)
    r = z / relaxes * per_path(x) * V(x)
    grown = np.exp(r @ rule.integral.T)
    P, Q = 1 / grown, (speed * grown) @ rule.integral.T / grown
    Q = Q * max(1.0, z)  # in what it settles to
    end = np.exp(-(r @ rule.weights))
    moved = 1 + (speed * (grown - 1)) @ rule.weights  # the path itself is known
    at_end = stiffness(np.ones(1))[:, 0] * end / min(1.0, z)
    # over the limit and the path, which is 1: sigma r / z of a deflection of 1, or of what it settles to
    heat = sigma * r / z
    integrals = [sigma * P, sigma * Q, sigma * P * speed, sigma * Q * speed]
    integrals += [heat * P * P, min(1.0, z) * heat * P * Q, min(1.0, z) * heat * Q * Q]
    return np.array([at_end, at_end * moved * max(1.0, z), *(f @ rule.weights for f in integrals)])


def main() -> None:
    scenes, exact = Scenes(np.random.default_rng(7)), Rule(EXACT)
    for n in (4, 6, 8, 12):
        rule, features, needed = Rule(n), [], []
        for phi in PHI:
            for mu in (m for m in MU if m * phi <= 8):
                for z in Z:
                    is_so = [results(scenes, which, exact, phi, mu, z) for which in (rule, exact)]
                    error = np.nanmax(abs(is_so[0] - is_so[1]))
                    if FITTED[0] < error < FITTED[1]:
                        features.append([1, phi, phi * mu, z, np.sqrt(z)])
                        needed.append(2.94 * n * error ** (0.5 / n))
        A, K = np.array(features), np.array(needed)
        fit = linprog(A.sum(0), A_ub=-A, b_ub=-K, bounds=[(0, None)] * 5).x
        decades = 2 * n * np.log10(A @ fit / K)
        above = ", ".join(f"{share} %: {np.percentile(decades, share):.1f}" for share in (50, 90, 100))
        print(
            f"    {{{n}, " + ", ".join(f"{c:.2f}" for c in np.ceil(fit * 100) / 100) + "},",
            f"// decades above, {above}",
        )


if __name__ == "__main__":
    main()
