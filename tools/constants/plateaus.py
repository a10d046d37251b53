"""The plateaus of the constants of solver/integrate/tuning.h: evaluations and errors at half and twice.

    .venv/bin/python -m tools.constants.plateaus            all, a quarter of an hour
    .venv/bin/python -m tools.constants.plateaus FC_SAFETY  these

The core is built anew with one number changed, and takes the scenes of the benchmarks. Evaluations are the
geometric mean over all of them, over that of today's numbers. The error is the worst one of F_t and its mean,
over the tolerance and the limit, against tools.reference.
"""

import argparse
import math
import re
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path

import fmpy
import numpy as np
from rich.progress import Progress

from frictioncontact.command import progress_bar
from frictioncontact.errors import UserError
from frictioncontact.files import write_whole
from tools.bench.cases import Case, cases, expected
from tools.bench.cost import LAWS, TOLERANCES
from tools.bench.driver import Bench, open_bench
from tools.project import ROOT

TUNING = Path("solver") / "integrate" / "tuning.h"
CONSTANT = re.compile(r"static const double (FC_\w+) = ([0-9.e-]+);")
OPTIONS = "-std=c11 -O1 -w -DNDEBUG -ffp-contract=off -fno-math-errno -fPIC -shared".split()


def constants() -> dict[str, float]:
    text = (ROOT / "fmu_src" / TUNING).read_text(encoding="utf-8")
    return {name: float(value) for name, value in CONSTANT.findall(text)}


def built(folder: Path, changed: Mapping[str, float]) -> Path:
    """The library of the core with those constants, from a header that is found before the core's."""
    sources, library = ROOT / "fmu_src", folder / "changed.so"
    text = (sources / TUNING).read_text(encoding="utf-8")
    for name, value in changed.items():
        text = re.sub(rf"(double {name} = )[0-9.e-]+;", rf"\g<1>{value!r};", text)
    write_whole(folder / TUNING, text)
    include = [f"-I{where}" for where in (folder, sources, Path(fmpy.__file__).parent / "c-code")]
    files = map(str, [*sources.rglob("*.c"), ROOT / "build/generated/variables.c"])
    done = subprocess.run(["gcc", *OPTIONS, *include, *files, "-o", library, "-lm"], stderr=subprocess.PIPE)
    if done.returncode:
        raise UserError(f"gcc: {done.stderr.decode().strip()}")
    return library


Scenes = list[tuple[Case, float, np.ndarray, np.ndarray]]  # with a start and what is right from it


def scenes(progress: Progress) -> Scenes:
    found = []
    runs = [*product(LAWS.items(), cases())]
    for (name, setting), case in progress.track(runs, description="The reference"):
        values, start = {**case.start_values, **setting}, case.starts[-1]  # not at a whole phase
        changed = replace(case, name=f"{name}, {case.name}", start_values=values)
        found.append((changed, start, *expected(changed, start)))
    return found


def take(bench: Bench, scenes: Scenes) -> tuple[np.ndarray, float, str]:
    """Evaluations of all runs, and the worst error over the tolerance, with its run."""
    evaluations, errors = [], {}
    for case, start, F, mean in scenes:
        limit = case.F_C * float(case.start_values.get("friction.staticRatio", 1.0))
        for tolerance in TOLERANCES:
            outcome = bench.run(case.job(start, 0.0, {"solver.tolerance": tolerance}))
            if outcome.failure:
                raise UserError(f"{case.name}: {outcome.failure}")
            evaluations.append(outcome.evaluations)
            off = max(np.abs(outcome.F - F).max(), np.abs(outcome.F_mean - mean).max())
            errors[f"{case.name} at {tolerance:g}"] = off / (limit * tolerance)
    where = max(errors, key=errors.__getitem__)
    return np.array(evaluations), errors[where], where


def main() -> None:
    parser = argparse.ArgumentParser(description="Plateaus of the solver's constants.")
    parser.add_argument("constants", nargs="*", metavar="CONSTANT", choices=[[], *constants()])
    wanted = parser.parse_args().constants or list(constants())
    changes = [{}, *({name: factor * constants()[name]} for name in wanted for factor in (0.5, 2.0))]
    with (
        progress_bar() as progress,
        tempfile.TemporaryDirectory() as temporary,
        open_bench(progress) as bench,
    ):
        known, today = scenes(progress), None
        print("| constant | evaluations | worst error | in |\n|---|---|---|---|")
        for change in changes:
            bench.library = built(Path(temporary), change)
            evaluations, worst, where = take(bench, known)
            today = evaluations if today is None else today
            ratio = math.exp(float(np.log(evaluations / today).mean()))
            name = ", ".join(f"{name} = {value:g}" for name, value in change.items()) or "today"
            print(f"| {name} | {ratio:.3f} | {worst:.3f} | {where} |", flush=True)


if __name__ == "__main__":
    main()
