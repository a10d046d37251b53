"""Levels of the model: how far simpler laws and contacts are from the scene's own, for typical scenes."""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from frictioncontact import command as shared
from frictioncontact.advice.answer import PHASES, STEPS
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import STIFFNESS_PRINTED, TABLE_2, start_values
from tools.bench.cases import Case, sampled, vibrating
from tools.bench.coupling import Belt, monolithic
from tools.bench.driver import REPORT
from tools.build import build_fmu
from tools.reference import Scene, changed, follow, rest, scene_of, settled_deflection

# Step by step a scene, and what the reference gives for it: F_t and its mean [N].
Run = list[tuple[Scene, tuple[float, float]]]


def runs_of(case: Case, phases: tuple[float, ...]) -> list[Run]:
    """With inputs over their samples, from delta_0 = 0; without over some steps from every phase of the
    vibration, from delta_0 = 0 and settled."""
    scene = scene_of(case.start_values)
    if case.inputs:
        return [_run(case, case.starts[0], 0.0)]
    starts = [phase / scene.f for phase in phases] if scene.vibrates else [0.0]
    return [
        _run(case, start, delta)
        for start in starts
        for delta in (0.0, settled_deflection(changed(scene, start=start)))
    ]


def _run(case: Case, start: float, delta_0: float) -> Run:
    ratios = [1.0] * case.count if case.inputs else STEPS
    steps = [changed(case.scene_at(k, start), h=x * case.step, delta_0=delta_0) for k, x in enumerate(ratios)]
    return [(scene, (found.F_t, found.F_t_mean)) for scene, found in zip(steps, follow(steps), strict=True)]


def largest_errors(
    fmu: FrictionFmu, case: Case, settings: Mapping[str, Value], runs: Sequence[Run]
) -> np.ndarray:
    """Largest errors [N] of F_t and F_t_mean of a case's scene solved with settings, against its runs."""
    errors = np.zeros(2)
    first = {name: float(samples[0]) for name, samples in case.inputs.items()}
    for run in runs:
        begin, _ = run[0]
        values = {**case.start_values, "delta_0": begin.delta_0, **settings, **first}
        with fmu.session(values, begin.start) as session:
            for scene, right in run:
                for name in case.inputs:
                    session.set(name, getattr(scene, name))
                if case.linear and case.inputs:
                    session.set_rates(**{name: getattr(scene, f"{name}_rate") for name in case.inputs})
                session.step(scene.h)
                errors = np.maximum(errors, np.abs(session.read(("F_t", "F_t_mean")) - right))
    return errors


def simpler(case: Case) -> dict[str, dict[str, Value]]:
    """Start values of the simpler levels, by the headings of their columns."""
    _, sigma = rest(scene_of(case.start_values))
    return {
        "Coulomb": {"friction.model": "Coulomb"},
        "ElasticPlastic": {"friction.model": "ElasticPlastic"},
        "contact Constant": {"contact.model": "Constant", "contact.sigma": sigma},
        "default at 1e-3": {"solver.tolerance": 1e-3},
    }


def _stick_slip() -> Case:
    """The velocity of the mass on a belt, as the monolithic reference has it."""
    belt, count = Belt(end=0.1), 100
    times = belt.end / count * np.arange(count + 1)
    velocity = np.array([belt.V(t) for t in times]) - monolithic(belt)(times)[1]
    values = {"F_C": belt.F_C, "contact.stiffnessScale": belt.sigma / STIFFNESS_PRINTED}
    where = {"step": belt.end / count, "count": count, "inputs": {"V": velocity}, "linear": True}
    return Case("stick-slip", "stick-slip on a belt", values, **where)


def scenes() -> list[Case]:
    """The scenes for which the table of levels is made."""
    wave = {"V": 0.3 * np.cos(2 * np.pi * np.arange(41) / 40)}
    soft, stiff, presliding = vibrating(2.5e6), vibrating(6e12), sampled(40, 2.5e6, linear=True)
    return [
        Case("steady", "steady sliding, 0.1 ms steps", {}, step=1e-4),
        *(Case(f"row-{row.number}", f"Table 2, row {row.number}", start_values(row)) for row in TABLE_2),
        replace(presliding, name="presliding", title="presliding hysteresis", inputs=wave),
        _stick_slip(),
        replace(soft, name="soft", title="soft contact, V and d vibrate"),
        replace(stiff, name="stiff", title="stiff contact, V and d vibrate"),
        replace(soft, name="many-periods", title="soft contact, 1 ms steps over 20 kHz", step=1e-3),
    ]


def row_of(fmu: FrictionFmu, case: Case, phases: tuple[float, ...]) -> dict[str, object]:
    """A scene's line of the table: a column a level, its largest errors of F_t and F_t_mean over F_C."""
    runs = runs_of(case, phases)
    row: dict[str, object] = {"scene": case.title}
    for level, settings in simpler(case).items():
        errors = largest_errors(fmu, case, settings, runs)
        row[level] = ", ".join(f"{error / case.F_C:.0e}" for error in errors)
    return row


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = shared.command_line("bench/levels", __doc__)
    parser.add_argument("--quick", action="store_true", help="from two phases instead of five")
    shared.add_fmu(parser)
    shared.add_output(parser, REPORT)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    phases = PHASES[:2] if options.quick else PHASES
    with shared.progress_bar() as progress, FrictionFmu(options.fmu or build_fmu()) as fmu:
        rows = [row_of(fmu, case, phases) for case in progress.track(scenes(), description="Grading levels")]
    title = "Largest errors of F_t and of its mean, over F_C"
    cells = [[*map(str, row.values())] for row in rows]
    shared.table_console().print(shared.as_table(list(rows[0]), cells, title))
    shared.say_written([shared.write_csv(rows, options.output / "levels.csv")])
