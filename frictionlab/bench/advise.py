"""The cheapest level, method and step for a scene and an accuracy."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.progress import Progress
from rich.table import Table

from frictionlab.bench import figures
from frictionlab.bench.cases import Case
from frictionlab.bench.driver import (
    Bench,
    bench_options,
    open_bench,
    renew_docs,
    wide_console,
    write_machine,
)
from frictionlab.bench.levels import ACCURACIES, OUTPUTS, Graded, best_of_each_kind, cheapest, grade, scenes
from frictionlab.bench.stuck_mass import MASTERS, advice
from frictionlab.build import build_fmu
from frictionlab.command import finish, progress_bar, say_written, write_csv
from frictionlab.fmu import INPUTS, FrictionFmu, Session, Value
from frictionlab.project import UserError
from frictionlab.reference.scene import Scene
from frictionlab.reference.start_values import scene_of, start_values_of
from frictionlab.values import Variables, assignment, csv_rows, number

DESCRIPTION = """\
Finds what a scene needs: tries every level of the model (Coulomb or Dahl friction, constant or asperity
contact) with every method on it, grades each against the full model's reference solution, and prints the
cheapest within the wanted accuracy as start values for fmpy.

  scripts/advise --accuracy 1e-3 vibration.V_1=1.44 vibration.a_d=1.1e-6 V=0.005
  scripts/advise --accuracy 1e-2 --step 1e-3 --output-of F_t_mean vibration.V_1=1.44
  scripts/advise --inputs drive.csv --linear contact.stiffnessScale=1e-6
  scripts/advise --scenes       the table of levels for typical scenes, with its CSV and picture

With --mass it says how to couple the contact to a mass while it sticks: the damping friction.sigma_1 that
keeps the master's exchange stable at the communication step, and the largest step.

  scripts/advise --mass 1 --step 1e-4 contact.model=Constant contact.sigma=1e6"""

SCENE_VARIABLES = tuple(start_values_of(Scene()))
COUNT = 4  # communication steps tried where no inputs are given
LONGEST = 400  # communication steps taken from a file of inputs


def arguments(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = bench_options("advise", DESCRIPTION)
    parser.add_argument("values", nargs="*", metavar="NAME=VALUE", help="start values of the scene")
    parser.add_argument("--accuracy", type=float, default=1e-3, help="largest error over F_C (1e-3)")
    parser.add_argument("--step", type=float, help="communication step, s (a vibration period)")
    parser.add_argument(
        "--mass", type=float, help="mass that moves with the contact, kg: advise on the coupling"
    )
    parser.add_argument(
        "--master", choices=MASTERS, default=MASTERS[0], help="how the master exchanges values"
    )
    parser.add_argument("--output-of", choices=OUTPUTS, default="both", help="which output must be accurate")
    parser.add_argument("--inputs", type=Path, help="CSV with time, in even steps, and any of V, d, E")
    parser.add_argument("--linear", action="store_true", help="inputs move linearly between their samples")
    parser.add_argument("--scenes", action="store_true", help="the table of levels for typical scenes")
    return parser.parse_args(argv)


def start_values(words: Sequence[str], fmu: FrictionFmu) -> dict[str, Value]:
    variables = Variables(fmu.description)
    values: dict[str, Value] = {}
    for name, text in map(assignment, words):
        if name not in SCENE_VARIABLES:
            raise UserError(f"{name} does not describe a scene; these do: {', '.join(SCENE_VARIABLES)}")
        values[name] = variables.value(name, text, name)
    return values


def read_inputs(path: Path) -> tuple[float, float, dict[str, np.ndarray]]:
    """Start [s], step [s] and samples of the inputs."""
    rows = list(csv_rows(path))
    header = rows[0][1] if rows else []
    names = [name for name in header if name in INPUTS]
    if not names or "time" not in header or len(rows) < 3:
        raise UserError(f"{path}: needs a column time, at least one of V, d, E, and at least two rows")
    rows = rows[1 : LONGEST + 2]
    for line, cells in rows:
        if len(cells) != len(header):
            raise UserError(f"{path}, line {line}: has {len(cells)} cells where the header has {len(header)}")
    columns = {
        name: np.array(
            [number(cells[header.index(name)], f"{path}, line {line}, {name}") for line, cells in rows]
        )
        for name in ("time", *names)
    }
    time = columns.pop("time")
    step = float(time[-1] - time[0]) / (len(time) - 1)
    uneven = np.abs(np.diff(time) - step) > 1e-6 * step
    if step <= 0 or uneven.any():
        line = rows[int(np.argmax(uneven)) + 1][0]
        raise UserError(f"{path}, line {line}: time must grow in even steps")
    return float(time[0]), step, columns


def case_of(options: argparse.Namespace, fmu: FrictionFmu) -> Case:
    if not 1e-11 <= options.accuracy <= 1.0:
        raise UserError(f"--accuracy {options.accuracy:g}: must lie between 1e-11 and 1")
    values = start_values(options.values, fmu)
    if options.inputs:
        if options.step is not None:
            raise UserError("--step and --inputs: the file's own time steps are used; leave --step out")
        start, step, inputs = read_inputs(options.inputs)
        count = len(next(iter(inputs.values()))) - 1
        case = Case("scene", "scene", values, step, count, (start,), inputs, options.linear)
    else:
        step = 1.0 / scene_of(values).f if options.step is None else options.step
        if not (0.0 < step < float("inf")):
            raise UserError(f"--step {step:g} s: must be a finite number above 0")
        case = Case("scene", "scene", values, step, COUNT)
    with fmu.session({**values, **{name: float(v[0]) for name, v in case.inputs.items()}}):
        return case  # the FMU has checked the values


def advise(bench: Bench, options: argparse.Namespace, progress: Progress) -> None:
    case = case_of(options, bench.fmu)
    task = progress.add_task("Trying every level", total=None)
    graded = grade(bench, case, options.quick)
    progress.remove_task(task)
    progress.stop()
    output = options.output_of
    table = Table(title="The most accurate setting of each level", title_justify="left")
    for heading in ("level", "error over F_C", "us per step"):
        table.add_column(heading, no_wrap=True, justify="left" if heading == "level" else "right")
    per_step = case.step / 50e-6  # costs are kept per 50 us simulated
    for g in sorted(best_of_each_kind(graded, output).values(), key=lambda g: g.error(output)):
        table.add_row(str(g.level), f"{g.error(output):.1e}", f"{1e6 * g.point.cpu * per_step:.3g}")
    wide_console().print(table)
    best = cheapest(graded, options.accuracy, output)
    if best is None:
        raise UserError(
            f"no level and method reaches {options.accuracy:g} F_C here; the table says what each does"
        )
    print(text_of(best, case, options, per_step))


def text_of(best: Graded, case: Case, options: argparse.Namespace, per_step: float) -> str:
    settings = {**case.start_values, **best.level.settings(case)}
    words = " ".join(f"{name} {value}" for name, value in settings.items())
    scene = scene_of(case.start_values)
    inputs = f", inputs {'linear' if case.linear else 'held'}" if case.inputs else ""
    error = best.error(options.output_of)
    cost, evaluations = 1e6 * best.point.cpu * per_step, best.point.evaluations * per_step
    lines = [
        f"\nCheapest within {options.accuracy:g} F_C: {best.level}",
        f"communication step {case.step:.6g} s{inputs}; expected error {error:.1e} F_C, "
        f"{cost:.3g} us and {evaluations:.0f} evaluations a step",
    ]
    if scene.vibrates and case.step * scene.f > 0.5:
        lines.append("The step exceeds half a vibration period: connect F_t_mean, not F_t.")
    lines.append(
        f"\nfmpy simulate build/FrictionContact.fmu --output-interval {case.step:.6g} --start-values {words}"
    )
    return "\n".join(lines)


def table_of_scenes(bench: Bench, options: argparse.Namespace, progress: Progress) -> None:
    cases = scenes()
    task = progress.add_task("Grading levels", total=len(cases))
    rows: list[dict[str, object]] = []
    names: list[dict[str, object]] = []
    for case in cases:
        progress.update(task, description=case.title)
        graded = grade(bench, case, options.quick)
        rows += [{"level": str(g.level), "kind": g.kind, **g.point.row()} for g in graded]
        summary: dict[str, object] = {"scene": case.title}
        for accuracy in ACCURACIES:
            best = cheapest(graded, accuracy)
            summary[f"{accuracy:g}"] = (
                f"{best.level}: {best.error():.0e}, {1e6 * best.point.cpu:.2f} us" if best else "none"
            )
        kinds = best_of_each_kind(graded)
        fails = [kind for kind in ("Coulomb", "Dahl, Constant, collocation") if kind in kinds]
        summary["off by"] = "; ".join(
            f"{kind.removesuffix(', collocation')} {kinds[kind].error():.0e}"
            for kind in fails
            if kinds[kind].error() > ACCURACIES[0]
        )
        names.append(summary)
        progress.advance(task)
    written = [
        write_csv(rows, options.output / "levels.csv"),
        write_csv(names, options.output / "levels-cheapest.csv"),
        write_machine(options.output / "machine.json"),
        *figures.levels(rows, {case.name: case.title for case in cases}, options.output),
    ]
    if options.docs:
        written += renew_docs(written)
    progress.stop()
    table = Table(
        title="Cheapest level within 1 %, 0.1 % and 1e-6 of F_C: error, CPU time per 50 us simulated; "
        "and simpler models that are off by more than 1 %",
        title_justify="left",
    )
    for heading in names[0]:
        table.add_column(heading)
    for summary in names:
        table.add_row(*map(str, summary.values()))
    wide_console().print(table)
    say_written(written)


def advise_on_coupling(options: argparse.Namespace) -> None:
    if not 0.0 < options.mass < float("inf"):
        raise UserError(f"--mass {options.mass:g} kg: must be a finite number above 0")
    if options.step is None or not 0.0 < options.step < float("inf"):
        raise UserError("--mass needs --step, the communication step: a finite number of seconds above 0")
    with progress_bar() as progress, FrictionFmu(build_fmu(progress=progress)) as fmu:
        values = start_values(options.values, fmu)
        with fmu.session(values) as session:
            sigma = stiffest(session)
    print(advice(options.mass, sigma, options.master, options.step, values))


def stiffest(session: Session) -> float:
    """The largest stiffness [N/m] over a period of the vibration, at 64 of its moments."""
    found = session.get("sigma")
    if session.get("vibration.a_d") > 0.0:
        for _ in range(64):
            session.step(1.0 / (64.0 * session.get("vibration.f")))
            found = max(found, session.get("sigma"))
    return found


def run(options: argparse.Namespace) -> None:
    if options.mass is not None:
        advise_on_coupling(options)
        return
    with progress_bar() as progress, open_bench(options.build_dir, progress) as bench:
        (table_of_scenes if options.scenes else advise)(bench, options, progress)


def main(argv: Sequence[str] | None = None) -> None:
    finish(run, arguments(argv))


if __name__ == "__main__":
    sys.exit(main())
