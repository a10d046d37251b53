"""Fits what the rule of the settled lag misses: error_of_rule in solver/stretches/settled_lag.c.

    .venv/bin/python -m workshop.constants.lag_rule

Between two reversals V = mean + cos(theta) and ln(sigma) = m cos(theta + alpha), in units of 1/omega.
The lag -(1 / sigma)' / |V| has a pole at each reversal. With the poles taken out, that of the end as it
is and that of the start as far as it lies before the span, 12 Gauss nodes integrate the rest; the slope
of 1 / sigma is that of the polynomial through them. The error over random stretches, over the integral
of the lag, of what is left of it, and of the poles, is written as

    ((a + b c^2) / 35.3)^12,    c = T (1 + m) / 2,

half of what the phase and ln(sigma) move by over the span T at the most. A linear programme finds the
least a and b that are nowhere below. tests/unit/test_settled_lag.c holds the rule to the equation.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.optimize import linprog

NODES, FINE, DRAWS = 12, 400, 4000
SCALE = 35.3


def slopes(x: np.ndarray) -> np.ndarray:
    """Of the polynomial through values at x, at x."""
    apart = x[:, None] - x + np.eye(x.size)
    factors = apart.prod(1)
    matrix = factors[:, None] / (factors * apart)
    np.fill_diagonal(matrix, 0)
    return matrix - np.diag(matrix.sum(1))


def error_of_one(generator: np.random.Generator) -> tuple[float, float]:
    """c and the error of a random stretch."""
    mean, m = generator.uniform(-0.9, 0.9), generator.uniform(0, 1.5)
    alpha = generator.uniform(0, 2 * np.pi)
    last = np.arccos(-mean)  # V > 0 from -last to last
    start = last * (2 * 10 ** generator.uniform(-4, -0.3) - 1)
    T = last - start

    def V(t: np.ndarray) -> np.ndarray:  # that keeps its digits next to the reversals
        return 2 * np.sin((last - t) / 2) * np.sin((last + t) / 2)

    def inverse(t: np.ndarray) -> np.ndarray:  # 1 / sigma
        return np.exp(-m * np.cos(t + alpha))

    def lag(t: np.ndarray) -> np.ndarray:
        return -m * np.sin(t + alpha) * inverse(t) / V(t)

    distance = V(start) / -np.sin(start)
    before = lag(start) * distance if distance > 0 else 0.0
    ahead = -m * np.sin(last + alpha) * inverse(last) / np.sin(last)

    def poles(t: np.ndarray) -> np.ndarray:
        return before / (distance + t - start) + ahead / (last - t)

    fine, weights = leggauss(FINE)
    t = start + T * (fine + 1) / 2
    left = lag(t) - poles(t)
    layer = 1e-3 * T
    size = abs(before) * np.log1p(T / distance) if before else 0.0
    size += abs(ahead) * np.log(T / layer)
    size += T / 2 * (weights @ (abs(left) + np.where(last - t > layer, abs(lag(t)), 0)))
    x, few = leggauss(NODES)
    at = start + T * (x + 1) / 2
    slope = slopes(x) @ inverse(at) * 2 / T
    got = T / 2 * (few @ (-slope / V(at) - poles(at)))
    return T * (1 + m) / 2, abs(got - T / 2 * (weights @ left)) / max(size, 1e-300)


def main() -> None:
    generator = np.random.default_rng(5)
    c, errors = np.array([error_of_one(generator) for _ in range(DRAWS)]).T
    fitted = (errors > 1e-13) & (errors < 0.1)
    K = SCALE * errors[fitted] ** (1 / 12)
    features = np.column_stack([np.ones_like(K), c[fitted] ** 2])
    a, b = linprog(features.sum(0), A_ub=-features, b_ub=-K, bounds=[(0, None)] * 2).x
    a, b = np.ceil(10 * a) / 10, np.ceil(100 * b) / 100
    decades = 12 * np.log10(features @ [a, b] / K)
    above = ", ".join(f"{share} %: {np.percentile(decades, share):.1f}" for share in (50, 90, 100))
    print(f"a {a:.1f}, b {b:.2f}; {fitted.sum()} stretches, decades above, {above}")


if __name__ == "__main__":
    main()
