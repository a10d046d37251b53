"""The tables of the panels are what their program makes, and its nodes and weights are scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import roots_jacobi, roots_legendre

from workshop.constants.panel_tables import GAUSS, HEADER, RADAU, Rule, gauss_nodes, radau_nodes, tables


def test_the_header_is_what_the_program_writes() -> None:
    assert HEADER.read_text(encoding="utf-8") == tables()


@pytest.mark.parametrize("n", [*GAUSS, -RADAU])
def test_nodes_and_weights(n: int) -> None:
    """On [-1, 1]. Radau's nodes besides 1 are the roots of a Jacobi polynomial, with the weight 1 - x."""
    rule = Rule(gauss_nodes(n) if n > 0 else radau_nodes(-n))
    if n > 0:
        x, w = roots_legendre(n)
    else:
        x, w = roots_jacobi(-n - 1, 1, 0)
        x, w = np.append(x, 1.0), np.append(w / (1.0 - x), 2.0 / n**2)
    assert np.array(rule.nodes, float) == pytest.approx((1.0 + x) / 2.0, rel=1e-13)
    assert np.array(rule.weights, float) == pytest.approx(w / 2.0, rel=1e-12)


@pytest.mark.parametrize("k", range(RADAU))
def test_polynomials(k: int) -> None:
    """c^k at the nodes: its integral, its slope, its value at 0, its tail of Legendre coefficients."""
    c = np.array(radau_nodes(RADAU), float)
    rule = Rule(radau_nodes(RADAU))
    integral, slope = (np.array(matrix.tolist(), float) for matrix in (rule.integral, rule.slope))
    assert integral @ c**k == pytest.approx(c ** (k + 1) / (k + 1), rel=1e-12)
    assert slope @ c**k == pytest.approx(k * c ** (k - 1.0), rel=1e-9, abs=1e-9)
    assert np.array(rule.start, float) @ c**k == pytest.approx(float(k == 0), abs=1e-9)
    series = np.polynomial.Polynomial([0.0] * k + [1.0], domain=[-1, 1], window=[-1, 1])
    shifted = series(np.polynomial.Polynomial([0.5, 0.5]))  # c = (1 + x) / 2
    legendre = np.zeros(RADAU)
    legendre[: k + 1] = np.polynomial.legendre.poly2leg(shifted.coef)
    assert c**k @ np.array(rule.tail, float) == pytest.approx(legendre[:-5:-1], abs=1e-12)
