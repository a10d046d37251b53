"""Writes documentation/fmi-ls-ref.html of the FMU: what its related files are for, as FMI-LS-REF recommends.

    python -m workshop.related.page HTML

The build makes the page.
"""

import sys
from html import escape
from itertools import groupby
from pathlib import Path

from workshop.presets import Preset, presets
from workshop.project import ROOT
from workshop.related.experiments import Experiment, experiments
from workshop.related.files import CHECKSUMS, EXPERIMENTS, FOLDER

TEMPLATE = ROOT / "docs" / "fmu" / "related.html"


def page() -> str:
    """The text of the page."""
    return TEMPLATE.read_text(encoding="utf-8").format(
        folder=FOLDER,
        experiments=EXPERIMENTS,
        checksums=CHECKSUMS,
        runs="\n".join(map(_run, experiments())),
        sets="\n".join(
            _sets(note, list(same)) for note, same in groupby(presets(), lambda preset: preset.note)
        ),
    )


def _run(run: Experiment) -> str:
    own = "The start values of the model description"
    start = f"Parameters {_link(f'{run.name}.ssv')}" if run.values else own
    steps = f"{1e6 * run.stop:g} µs in steps of {1e6 * run.step:g} µs, tolerance {run.tolerance:g}"
    return f"<dt>{_link(run.result.name)}: {escape(run.description)}</dt>\n<dd>{start}; {steps}.</dd>"


def _sets(note: str, sets: list[Preset]) -> str:
    """Those of one note, which is HTML."""
    terms = [
        f"<dt>{_link(f'{preset.id}.ssv')}: {escape(preset.title)}{_known(preset)}</dt>" for preset in sets
    ]
    return "\n".join([*terms, f"<dd>{note}</dd>"])


def _known(preset: Preset) -> str:
    if preset.known is None:
        return ""
    return f" (mean friction {preset.known:g} N: {str(preset.known_from).lower()})"


def _link(name: str) -> str:
    return f'<a href="../{FOLDER}/{name}">{name}</a>'


if __name__ == "__main__":
    try:
        Path(sys.argv[1]).write_text(page(), encoding="utf-8")
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
