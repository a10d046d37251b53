"""Writes the tables of the solver's panels: fmu_src/solver/panels/panel_tables.h.

    .venv/bin/python -m workshop.constants.panel_tables

They are kept with the sources, so that a build needs no mpmath. tests/solver/test_panel_tables.py has
other formulas. All follow from the nodes c_i on [0, 1], the roots of the Legendre polynomial P_n(2 c - 1) for
Gauss and of P_n - P_(n-1) for Radau: the integrals and slopes of the polynomials through values at the
nodes, their Legendre coefficients, their value at 0.
"""

from collections.abc import Callable

import numpy as np
from mpmath import mp, mpf
from scipy.special import roots_jacobi, roots_legendre

from workshop.project import ROOT

mp.dps = 60
GAUSS, RADAU = (4, 6, 8, 12), 9
HEADER = ROOT / "fmu_src" / "solver" / "panels" / "panel_tables.h"


def roots(polynomial: Callable[[mpf], mpf], near: np.ndarray) -> list[mpf]:
    """Of a polynomial on [-1, 1], each next to a number, on [0, 1]."""
    return [(1 + mp.findroot(polynomial, (mpf(x), mpf(x) + 1e-13))) / 2 for x in near]


def gauss_nodes(n: int) -> list[mpf]:
    return roots(lambda x: mp.legendre(n, x), roots_legendre(n)[0])


def radau_nodes(n: int) -> list[mpf]:
    inner = roots(lambda x: mp.legendre(n, x) - mp.legendre(n - 1, x), roots_jacobi(n - 1, 1, 0)[0])
    return [*inner, mpf(1)]


class Rule:
    """What follows from n nodes: functions of their values, as matrices and rows."""

    def __init__(self, nodes: list[mpf]) -> None:
        n = len(nodes)
        self.nodes = nodes
        powers = mp.matrix([[c**j for j in range(n)] for c in nodes])
        integrals = mp.matrix([[c ** (j + 1) / (j + 1) for j in range(n)] for c in nodes])
        slopes = mp.matrix([[j * c ** (j - 1) for j in range(n)] for c in nodes])
        legendres = mp.matrix([[mp.legendre(j, 2 * c - 1) for j in range(n)] for c in nodes])
        from_values = powers**-1
        self.integral = integrals * from_values
        self.slope = slopes * from_values
        self.weights = list(mp.matrix([[mpf(1) / (j + 1) for j in range(n)]]) * from_values)
        self.start = [from_values[0, j] for j in range(n)]  # the polynomial's value at 0
        of_degree = legendres**-1
        self.tail = [[of_degree[max(n - k, 0), j] for k in range(1, 5)] for j in range(n)]


def row(values: list[mpf]) -> str:
    return "{" + ", ".join(repr(float(value)) for value in values) + "}"


def rows(values: list[list[mpf]]) -> str:
    return "{" + ",\n     ".join(row(line) for line in values) + "}"


def header(guard: str, body: list[str]) -> str:
    lines = ["// Made by workshop.constants.panel_tables, which describes the entries."]
    lines += ["// clang-format off", f"#ifndef {guard}", f"#define {guard}", ""]
    lines += ['#include "solver/panels/arithmetic.h"', "", *body, f"#endif  // {guard}"]
    return "\n".join(lines) + "\n"


GAUSS_STRUCT = """typedef struct {
    double node[12];         // on [-1/2, 1/2]
    double weight[12];       // of the integral over the panel
    double integral[12][12]; // [j][i]: weight of node j in the integral up to node i
    double tail[12][4];      // [j][k]: weight of node j in the Legendre coefficient of degree n - 1 - k
} FC_PAIRED FcGaussRule;
"""

RADAU_STRUCT = """// After the stages, the panel's start.
typedef struct {
    double node[10];       // on [-1/2, 1/2]
    double weight[10];     // of the integral over the panel
    double start[10];      // value at the start of the polynomial through the stages, less the value there
    double inverse[9][10]; // of the Runge-Kutta matrix
    double tail[10][4];    // [j][k]: weight of node j in the Legendre coefficient of degree n - 1 - k
} FC_PAIRED FcRadauRule;
"""


def columns(matrix: mp.matrix, n: int) -> list[list]:
    return [[matrix[i, j] for i in range(n)] for j in range(n)]


def gauss_table(n: int) -> str:
    rule = Rule(gauss_nodes(n))
    return f"""// Computed by workshop.constants.panel_tables: the Gauss rule of {n} nodes.
static const FcGaussRule FC_GAUSS_{n} = {{
    {row([c - mpf(1) / 2 for c in rule.nodes])},
    {row(rule.weights)},
    {rows(columns(rule.integral, n))},
    {rows(rule.tail)},
}};
"""


def slope_table(n: int) -> str:
    return f"""// Computed so too. [j][i]: weight of node j in the slope at node i
static const double FC_GAUSS_{n}_SLOPE[{n}][{n}] = {rows(columns(Rule(gauss_nodes(n)).slope, n))};
"""


def radau_table(n: int) -> str:
    rule = Rule(radau_nodes(n))
    inverse = rule.integral**-1
    return f"""// Computed so too: Radau IIA of {n} stages.
static const FcRadauRule FC_RADAU_{n} = {{
    {row([*(c - mpf(1) / 2 for c in rule.nodes), -mpf(1) / 2])},
    {row([*rule.weights, mpf(0)])},
    {row([*rule.start, -mpf(1)])},
    {rows([[inverse[i, j] for j in range(n)] for i in range(n)])},
    {rows([*rule.tail, [mpf(0)] * 4])},
}};
"""


def tables() -> str:
    """Text of the header."""
    body = [GAUSS_STRUCT, *map(gauss_table, GAUSS), slope_table(GAUSS[-1]), RADAU_STRUCT, radau_table(RADAU)]
    return header("FC_SOLVER_PANEL_TABLES_H", body)


def main() -> None:
    HEADER.write_text(tables())


if __name__ == "__main__":
    main()
