"""Writes documentation/fmi-ls-ref.html of the FMU: what its related files are for, as FMI-LS-REF recommends.

    python -m workshop.related.page HTML

The build makes the page.
"""

import sys
from html import escape
from itertools import groupby
from pathlib import Path

from workshop.presets import Preset, presets
from workshop.related.experiments import Experiment, experiments
from workshop.related.files import CHECKSUMS, EXPERIMENTS, FOLDER

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>FrictionContact: related files</title>
<style>
body {{ font: 1rem/1.6 system-ui, sans-serif; max-width: 62rem; margin: 0 auto; padding: 1.5rem 1rem; }}
body, code {{ overflow-wrap: anywhere; }}
dd {{ margin: 0 0 1rem 1.5rem; }}
</style>
</head>
<body>
<main>
<h1>Related files of FrictionContact</h1>
<p><a href="index.html">FrictionContact</a> carries them in <code>{folder}/</code>,
under the manifest of the layered standard FMI-LS-REF.</p>
<h2>Experiments</h2>
<p><a href="../{folder}/{experiments}">{experiments}</a> describes runs from <var>t</var> = 0
whose results the FMU must give in any tool. A solver that shares no code with the FMU computed them. At every
step each output may differ from them by at most the tolerance times its own largest value in the run.</p>
<dl>
{runs}
</dl>
<h2>Parameter sets</h2>
<p>Start values of scenes, as parameter sets of SSP 1.0; all others keep the start values of the model
description. The page of the live FMU offers the same scenes; figure c, where named, is that page's.</p>
<dl>
{sets}
</dl>
<h2>Checksums</h2>
<p><a href="../{folder}/{checksums}">{checksums}</a> holds the SHA-256 sum of every other file
as it was packed.</p>
</main>
</body>
</html>
"""


def page() -> str:
    """The text of the page."""
    return PAGE.format(
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
    if len(sys.argv) != 2:
        sys.exit("usage: python -m workshop.related.page HTML")
    try:
        Path(sys.argv[1]).write_text(page(), encoding="utf-8")
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
