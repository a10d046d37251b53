"""Writes the tables of the solver's panels: fmu_src/solver/panel/panel_tables.h.

    .venv/bin/python -m tools.constants.panel_tables

They are kept with the sources, so that a build needs no mpmath. tests/solver/test_panel_tables.py has
other formulas. All follow from the nodes c_i on [0, 1], the roots of P_n - P_(n-1) with the Legendre
polynomials P_n(2 c - 1): the integrals of the polynomials through values at the nodes, their Legendre
coefficients, their values at 0 and, with the panel's start as a tenth point, after 32 equal steps.
"""

import numpy as np
from mpmath import mp, mpf
from scipy.special import roots_jacobi

from tools.project import ROOT

mp.dps = 60
STAGES, SAMPLES = 9, 32
TAIL = (8, 7, 6, 5, 2, 1)  # degrees by which the error of a panel is estimated
HEADER = ROOT / "fmu_src" / "solver" / "panel" / "panel_tables.h"


def radau_nodes(n: int) -> list[mpf]:
    """Of Radau IIA with n stages, on [0, 1]; the last one is 1."""
    near: np.ndarray = roots_jacobi(n - 1, 1, 0)[0]

    def polynomial(x: mpf) -> mpf:
        return mp.legendre(n, x) - mp.legendre(n - 1, x)

    return [*((1 + mp.findroot(polynomial, (mpf(x), mpf(x) + 1e-13))) / 2 for x in near), mpf(1)]


class Rule:
    """What follows from n nodes: functions of their values, as matrices and rows."""

    def __init__(self, nodes: list[mpf]) -> None:
        n = len(nodes)
        self.nodes = nodes
        powers = mp.matrix([[c**j for j in range(n)] for c in nodes])
        integrals = mp.matrix([[c ** (j + 1) / (j + 1) for j in range(n)] for c in nodes])
        legendres = mp.matrix([[mp.legendre(j, 2 * c - 1) for j in range(n)] for c in nodes])
        from_values = powers**-1
        self.integral = integrals * from_values
        self.weights = list(mp.matrix([[mpf(1) / (j + 1) for j in range(n)]]) * from_values)
        self.start = [from_values[0, j] for j in range(n)]  # the polynomial's value at 0
        of_degree = legendres**-1
        self.tail = [[of_degree[k, j] for k in TAIL] for j in range(n)]


def barycentric_weights(points: list[mpf]) -> list[mpf]:
    """Up to a common factor, which keeps them near 1."""
    return [1 / mp.fprod(4 * (a - b) for b in points if b is not a) for a in points]


def values_at(points: list[mpf], x: mpf) -> list[mpf]:
    """The weights of the values at the points in the value at x of the polynomial through them."""
    if x in points:
        return [mpf(point == x) for point in points]
    parts = [w / (x - point) for w, point in zip(barycentric_weights(points), points, strict=True)]
    return [part / mp.fsum(parts) for part in parts]


def row(values: list[mpf]) -> str:
    return "{" + ", ".join(repr(float(value)) for value in values) + "}"


def rows(values: list[list[mpf]]) -> str:
    return "{" + ",\n     ".join(row(line) for line in values) + "}"


def tables() -> str:
    """Text of the header."""
    rule = Rule(radau_nodes(STAGES))
    inverse = rule.integral**-1
    points = [*rule.nodes, mpf(0)]
    samples = list(zip(*(values_at(points, mpf(k) / SAMPLES) for k in range(1, SAMPLES + 1)), strict=True))
    return f"""// Made by tools.constants.panel_tables, which describes the entries.
// clang-format off
#ifndef FC_SOLVER_PANEL_PANEL_TABLES_H
#define FC_SOLVER_PANEL_PANEL_TABLES_H

#include "solver/panel/arithmetic.h"

// The number of stages. The points of a panel are its stages, and then its start.
enum {{ FC_STAGES = {STAGES}, FC_POINTS = FC_STAGES + 1, FC_SAMPLES = {SAMPLES} }};

typedef struct {{
    double node[10];       // on [-1/2, 1/2]
    double weight[10];     // of the integral over the panel
    double start[10];      // value at the start of the polynomial through the stages, less the value there
    double inverse[9][10]; // of the Runge-Kutta matrix
    double matrix[9][10];  // [i][j]: weight of node j in the integral up to node i
    double tail[10][6];    // [j][k]: weight of node j in the Legendre coefficient of degree 8, 7, 6, 5, 2 and 1
    double barycentric[10];
    double sample[10][{SAMPLES}];  // [j][k]: weight of point j in the value of the polynomial after the part (k + 1) / {SAMPLES}
}} FC_PAIRED FcRadauRule;

// Radau IIA of {STAGES} stages.
static const FcRadauRule FC_RADAU = {{
    {row([*(c - mpf(1) / 2 for c in rule.nodes), -mpf(1) / 2])},
    {row([*rule.weights, mpf(0)])},
    {row([*rule.start, -mpf(1)])},
    {rows([[inverse[i, j] for j in range(STAGES)] for i in range(STAGES)])},
    {rows([[*rule.integral[i, :], mpf(0)] for i in range(STAGES)])},
    {rows([*rule.tail, [mpf(0)] * len(TAIL)])},
    {row(barycentric_weights(points))},
    {rows([list(of_point) for of_point in samples])},
}};

#endif  // FC_SOLVER_PANEL_PANEL_TABLES_H
"""  # noqa: E501


def main() -> None:
    HEADER.write_text(tables())


if __name__ == "__main__":
    main()
