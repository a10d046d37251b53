"""Where each method is stable: alone, over z = sigma |V| h / F_C, and coupled to a mass on a belt."""

import argparse
from collections.abc import Sequence
from functools import partial

import numpy as np
from rich.table import Table

from frictioncontact.command import as_table, finish, say_written, table_console, write_csv
from frictioncontact.fmu import FrictionFmu
from workshop.bench import figures
from workshop.bench.coupling import (
    COUPLINGS,
    Belt,
    coupled_edge,
    coupled_errors,
    monolithic,
    theoretical_edge,
)
from workshop.bench.driver import bench_options, renew_docs
from workshop.bench.exchange import against_cost
from workshop.bench.stability_map import EDGES, METHODS, classify, measured_edge
from workshop.build import build_fmu

DESCRIPTION = """\
Maps where each method is stable. First alone: z = sigma |V| h / F_C from 1e-3 to 1e8, with the theoretical
limits over the measured edges. Then coupled: a mass on a belt, advanced side by side with the FMU, with
friction held over a step or moving at its derivative, against a monolithic reference."""


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


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, bench_options("stability", DESCRIPTION).parse_args(argv))


def run(options: argparse.Namespace) -> None:
    output, quick = options.output, options.quick
    belt = Belt()
    with FrictionFmu(build_fmu()) as fmu:
        behaviours, found = stability_map(fmu, quick), edges(fmu)
        edge_of = {"theory_H": theoretical_edge, "measured_H": partial(coupled_edge, fmu)}
        coupled = [
            {"coupling": name} | {key: edge(belt, name) for key, edge in edge_of.items()}
            for name in COUPLINGS
        ]
        reference = monolithic(belt)
        counts = (500, 2000, 8000) if quick else tuple(250 * 2**k for k in range(8))
        errors = coupled_errors(fmu, belt, reference, counts) + against_cost(fmu)
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
