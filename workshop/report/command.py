"""The paper's figures, tables and claims from the FMU, the regimes and the identification on one page."""

import argparse
import platform
from collections.abc import Callable, Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path

from rich.progress import Progress

from frictioncontact.command import add_fmu, add_output, command_line, progress_bar
from frictioncontact.files import write_whole
from frictioncontact.fmu import FrictionFmu
from frictioncontact.table2 import results
from workshop.build import build_fmu
from workshop.figure import Figure
from workshop.figures import contact as contact_figures
from workshop.paper import figures as paper_figures
from workshop.paper.claims import claims
from workshop.project import ROOT
from workshop.regimes import figures as regime_figures
from workshop.regimes.mean import Probe
from workshop.report import recovery, text
from workshop.report.page import Section, page

DESCRIPTION = """\
Draws Figures 2-6 and 8-13 of the paper from the FMU, Table 2 and the abstract's claims with what the
equations give, the height statistics, the regimes and sensitivities of the mean friction, and the
identification. Writes build/report/index.html, one page that needs no network, and each figure as SVG and
PNG beside it."""

# Figures that the README and the documents show, and their names there.
IN_DOCS = ("fig-04", "fig-13", "heights", "mean", "regimes", "reduction", "sensitivity-cuts", "recovery")


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/report", DESCRIPTION)
    parser.add_argument("--quick", action="store_true", help="coarser maps, no PNG")
    add_fmu(parser)
    add_output(parser, ROOT / "build" / "report")
    parser.add_argument(
        "--docs",
        action="store_true",
        help="also renew the figures that docs/ shows, docs/pictures/paper-*.png",
    )
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    options.output.mkdir(parents=True, exist_ok=True)
    with progress_bar() as progress:
        path = options.fmu or build_fmu(progress=progress)
        with FrictionFmu(path) as fmu:
            figures = _figures(fmu, options.quick, progress)
            sections = text.sections(list(results(fmu)), claims(fmu), figures)
        index = options.output / "index.html"
        _write(index, sections, options.quick)
        written = _draw(figures, options, progress)
    print(f"Written: {index} and {len(written)} figures")


def _jobs(fmu: FrictionFmu, quick: bool) -> list[Callable[[], Figure]]:
    of_regimes = (
        regime_figures.means,
        regime_figures.regimes,
        regime_figures.reduction,
        regime_figures.sensitivity_cuts,
    )
    return [
        *(partial(draw, fmu) for draw in paper_figures.FIGURES),
        contact_figures.areas,
        *(partial(draw, Probe(fmu.path), quick) for draw in of_regimes),
        partial(recovery.figure, fmu, 4 if quick else 20),
    ]


def _figures(fmu: FrictionFmu, quick: bool, progress: Progress) -> dict[str, Figure]:
    jobs = _jobs(fmu, quick)
    task = progress.add_task("Simulating", total=len(jobs))
    found = {}
    for job in jobs:
        figure = job()
        found[figure.key] = figure
        progress.advance(task)
    progress.remove_task(task)
    return found


def _write(path: Path, sections: Sequence[Section], quick: bool) -> None:
    made = ", ".join(f"{name} {version(name)}" for name in ("FMPy", "numpy", "scipy", "matplotlib"))
    command = "scripts/report --quick" if quick else "scripts/report"
    footer = (
        f"Made by <code>{command}</code> with FrictionContact.fmu; Python {platform.python_version()}, "
        f"{made}; {platform.system()} {platform.machine()}."
    )
    write_whole(path, page(text.TITLE, text.LEDE, sections, footer))


def _draw(figures: dict[str, Figure], options: argparse.Namespace, progress: Progress) -> list[Path]:
    task = progress.add_task("Drawing", total=len(figures))
    written = []
    for key, figure in figures.items():
        paths = [options.output / f"{key}.svg"]
        if not options.quick:
            paths.append(options.output / f"{key}.png")
        figure.draw(*paths)
        if options.docs and key in IN_DOCS:
            paths.append(ROOT / "docs" / "pictures" / f"paper-{key}.png")
            figure.narrow().draw(paths[-1])
        written += paths
        progress.advance(task)
    progress.remove_task(task)
    return written
