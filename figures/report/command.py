"""Draws Figures 2-6 and 8-13 of the paper from the FMU, Table 2 and the abstract's claims with what the
equations give, the height statistics, and the regimes and sensitivities of the mean friction. Writes
build/report/index.html, one page that needs no network, and each figure as SVG and PNG beside it."""

import argparse
import platform
from collections.abc import Callable, Sequence
from functools import partial
from importlib.metadata import version

from figures.figure import Figure
from figures.report import paper, regimes
from figures.report.page import page
from frictioncontact.command import add_fmu, add_output, command_line, progress_bar
from frictioncontact.files import write_whole
from frictioncontact.fmu import FrictionFmu
from frictioncontact.table2 import results
from tools.build import build_fmu
from tools.project import ROOT

# Figures that the README and the documents show, and their names there.
IN_DOCS = ("fig-04", "heights", "mean", "regimes", "reduction")


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/report", __doc__)
    parser.add_argument("--quick", action="store_true", help="coarser maps, no PNG")
    add_fmu(parser)
    add_output(parser, ROOT / "build" / "report")
    what = "also renew the figures that docs/ shows, docs/pictures/paper-*.png"
    parser.add_argument("--docs", action="store_true", help=what)
    return parser.parse_args(argv)


def jobs(fmu: FrictionFmu, quick: bool) -> list[Callable[[], Figure]]:
    of_regimes = (regimes.means, regimes.regimes, regimes.reduction, regimes.sensitivity_cuts)
    return [
        *(partial(figure, fmu) for figure in paper.FIGURES),
        paper.heights,
        *(partial(figure, fmu.path, quick) for figure in of_regimes),
    ]


def run(options: argparse.Namespace) -> None:
    options.output.mkdir(parents=True, exist_ok=True)
    figures: dict[str, Figure] = {}
    with progress_bar() as progress:
        path = options.fmu or build_fmu(progress=progress)
        with FrictionFmu(path) as fmu:
            for job in progress.track(jobs(fmu, options.quick), description="Drawing"):
                figure = job()
                figures[figure.key] = figure
                endings = ("svg",) if options.quick else ("svg", "png")
                figure.draw(*(options.output / f"{figure.key}.{ending}" for ending in endings))
                if options.docs and figure.key in IN_DOCS:
                    figure.narrow().draw(ROOT / "docs" / "pictures" / f"paper-{figure.key}.png")
            tables = list(results(fmu)), paper.claims(fmu)
    made = ", ".join(f"{name} {version(name)}" for name in ("FMPy", "numpy", "scipy", "matplotlib"))
    footer = (
        f"Made by <code>scripts/report{' --quick' * options.quick}</code> with FrictionContact.fmu; "
        f"Python {platform.python_version()}, {made}; {platform.system()} {platform.machine()}."
    )
    index = options.output / "index.html"
    write_whole(index, page(*tables, figures, footer))
    print(f"Written: {index} and {len(figures)} figures")
