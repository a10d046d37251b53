"""The table of the panels is what its program makes, and follows from other formulas."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import roots_jacobi

from tools.constants.panel_tables import (
    HEADER,
    SAMPLES,
    STAGES,
    TAIL,
    Rule,
    mpf,
    radau_nodes,
    tables,
    values_at,
)

RULE = Rule(radau_nodes(STAGES))
POINTS = [*RULE.nodes, mpf(0)]


def test_the_header_is_what_the_program_writes() -> None:
    assert HEADER.read_text(encoding="utf-8") == tables()


def test_nodes_and_weights() -> None:
    """On [-1, 1] the nodes besides 1 are the roots of a Jacobi polynomial, with the weight 1 - x."""
    x, w = roots_jacobi(STAGES - 1, 1, 0)
    x, w = np.append(x, 1.0), np.append(w / (1.0 - x), 2.0 / STAGES**2)
    assert np.array(RULE.nodes, float) == pytest.approx((1.0 + x) / 2.0, rel=1e-13)
    assert np.array(RULE.weights, float) == pytest.approx(w / 2.0, rel=1e-12)


@pytest.mark.parametrize("k", range(STAGES + 1))
def test_polynomials(k: int) -> None:
    """c^k at the nodes: its integral, its value at 0, its tail of Legendre coefficients, its samples."""
    for i in range(SAMPLES + 1):  # of degree 9 at the ten points
        x = mpf(i) / SAMPLES
        weights = values_at(POINTS, x)
        assert abs(sum(w * point**k for w, point in zip(weights, POINTS, strict=True)) - x**k) < 1e-50
    if k == STAGES:
        return
    c = np.array(RULE.nodes, float)
    integral = np.array(RULE.integral.tolist(), float)
    assert integral @ c**k == pytest.approx(c ** (k + 1) / (k + 1), rel=1e-12)
    assert np.array(RULE.start, float) @ c**k == pytest.approx(float(k == 0), abs=1e-9)
    series = np.polynomial.Polynomial([0.0] * k + [1.0], domain=[-1, 1], window=[-1, 1])
    shifted = series(np.polynomial.Polynomial([0.5, 0.5]))  # c = (1 + x) / 2
    legendre = np.zeros(STAGES)
    legendre[: k + 1] = np.polynomial.legendre.poly2leg(shifted.coef)
    assert c**k @ np.array(RULE.tail, float) == pytest.approx(legendre[list(TAIL)], abs=1e-12)
