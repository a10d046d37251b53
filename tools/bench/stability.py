"""Maps where each method is stable. First alone: z = sigma |V| h / F_C from 1e-3 to 1e8, with the theoretical
limits over the measured edges. Then coupled: a mass on a belt, advanced side by side with the FMU, with
friction held over a step or moving at its derivative, against a monolithic reference."""

import argparse
import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from rich.table import Table

from frictioncontact.command import as_table, say_written, table_console, write_csv
from frictioncontact.fmu import FrictionError, FrictionFmu
from frictioncontact.parameters import COULOMB_FORCE, VELOCITY_IDENTIFIED
from tools.bench import coupling, figures
from tools.bench.driver import bench_options, renew_docs
from tools.bench.exchange import against_cost
from tools.build import build_fmu

SIGMA, V, F_C = 2.5e6, VELOCITY_IDENTIFIED, COULOMB_FORCE
STEPS = 40
TOLERANCE = 1e-6
ROUNDING = 1e-12
RK4_LIMIT = 2.785293563405282

FMU_METHODS = ("collocation", "cvode", "backwardEuler", "trapezoid", "rk4", "explicitEuler")
UNCHECKED = {"rk4, unchecked": 4, "explicitEuler, unchecked": 1}  # an FMU without the check, of this order
METHODS = (*FMU_METHODS, *UNCHECKED)

# Where one behaviour gives way to another, in theory.
EDGES = {
    "trapezoid": {("monotone", "rings"): 2.0},
    "rk4": {("monotone", "refuses"): RK4_LIMIT},
    "explicitEuler": {("monotone", "rings"): 1.0, ("rings", "refuses"): 2.0},
    "rk4, unchecked": {("monotone", "diverges"): RK4_LIMIT},
    "explicitEuler, unchecked": {("monotone", "rings"): 1.0, ("rings", "diverges"): 2.0},
}


def forces(fmu: FrictionFmu, method: str, z: float) -> np.ndarray:
    """F_t / F_C after each step of h = z F_C / (sigma V)."""
    h = z * F_C / (SIGMA * V)
    if method in UNCHECKED:
        return _unchecked(UNCHECKED[method], z)
    start = {
        "V": V,
        "contact.model": "Constant",
        "contact.sigma": SIGMA,
        "solver.method": method,
        "solver.stepSize": h,
        "solver.tolerance": TOLERANCE,
    }
    values = []
    with fmu.session(start) as session:
        for _ in range(STEPS):
            session.step(h)
            values.append(session.get("F_t"))
    return np.array(values) / F_C


def _unchecked(order: int, z: float) -> np.ndarray:
    """The same explicit steps of y' = 1 - y from 0: each multiplies 1 - y by exp(-z) up to its order in z."""
    growth = sum((-z) ** k / math.factorial(k) for k in range(order + 1))
    with np.errstate(over="ignore"):
        return 1.0 - growth ** np.arange(1.0, STEPS + 1.0)


def classify(fmu: FrictionFmu, method: str, z: float) -> str:
    """Steady sliding from rest, in which the force should rise from 0 to F_C. With e = 1 - F_t / F_C,

    monotone   |e| falls and keeps its sign
    rings      e changes sign from step to step, and falls
    stable     settles at F_C with an e of changing sign that is below the method's own tolerance
    diverges   |e| grows
    refuses    fmi2Error
    """
    try:
        error = 1.0 - forces(fmu, method, z)
    except FrictionError:
        return "refuses"
    error = np.concatenate([[1.0], error])
    size = np.abs(error)
    noise = TOLERANCE if method == "cvode" else ROUNDING
    seen = size > noise
    if size[-1] > size[0] or size[1] > size[0]:
        return "diverges"
    overshoots = (error < -noise).any()
    if overshoots:
        return "rings"
    falls = (np.diff(size)[seen[1:]] < 0).all()
    return "monotone" if falls and not (error < -ROUNDING).any() else "stable"


def measured_edge(fmu: FrictionFmu, method: str, before: str, theory: float) -> float:
    """Bisection for the z up to which the behaviour is the one before the edge."""
    low, high = 0.75 * theory, 1.4 * theory
    if classify(fmu, method, low) != before or classify(fmu, method, high) == before:
        raise ValueError(f"{method} has no edge from {before} between z = {low:.3g} and {high:.3g}")
    return coupling.edge(lambda z: classify(fmu, method, z) == before, low, high, 2e-4)


def stability_map(fmu: FrictionFmu, quick: bool) -> list[dict[str, object]]:
    exponents = np.linspace(-3, 8, 45 if quick else 177)
    return [
        {"method": method, "z": float(z), "behaviour": classify(fmu, method, float(z))}
        for method in METHODS
        for z in 10.0**exponents
    ]


def edges(fmu: FrictionFmu) -> list[dict[str, object]]:
    rows = []
    for method, limits in EDGES.items():
        for (before, after), theory in limits.items():
            found = measured_edge(fmu, method, before, theory)
            row = {"method": method, "from": before, "to": after, "theory_z": theory, "measured_z": found}
            rows.append({**row, "deviation": found / theory - 1})
    return rows


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    return bench_options("stability", __doc__).parse_args(argv)


def run(options: argparse.Namespace) -> None:
    output, quick = options.output, options.quick
    belt = coupling.Belt()
    with FrictionFmu(build_fmu()) as fmu:
        behaviours, found = stability_map(fmu, quick), edges(fmu)
        edge_of = {"theory_H": coupling.theoretical_edge, "measured_H": partial(coupling.coupled_edge, fmu)}
        coupled = [
            {"coupling": name} | {key: edge(belt, name) for key, edge in edge_of.items()}
            for name in coupling.COUPLINGS
        ]
        reference = coupling.monolithic(belt)
        counts = (500, 2000, 8000) if quick else tuple(250 * 2**k for k in range(8))
        errors = coupling.coupled_errors(fmu, belt, reference, counts) + against_cost(fmu)
    tables = {"stability": behaviours, "stability-edges": found}
    tables |= {"coupled-edges": coupled, "coupled-errors": errors}
    written = [write_csv(rows, output / f"{name}.csv") for name, rows in tables.items()]
    written += figures.stability(behaviours, found, output)
    written += figures.coupled(errors, coupled, reference, belt, output)
    if options.docs:
        written += renew_docs(written)
    console = table_console()
    console.print(_table("Edges in z = sigma |V| h / F_C", found))
    console.print(_table("Mass on a belt: largest stable communication step [s] in stick", coupled))
    say_written(written)


def _table(title: str, rows: Sequence[dict[str, object]]) -> Table:
    cells = [
        [f"{value:.4g}" if isinstance(value, float) else str(value) for value in row.values()] for row in rows
    ]
    return as_table(list(rows[0]), cells, title)
