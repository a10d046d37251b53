"""The pictures of README.md, the tutorial and the pages on use, equations and solver, into docs/pictures/."""

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from figures.pages import diagrams, directions, laws, march, solver
from figures.pages.tutorial import PAGES, blocks
from frictioncontact import style, table2
from frictioncontact.command import add_fmu, add_output, command_line
from frictioncontact.fmu import SETTLED, FrictionFmu, Session, simulate
from frictioncontact.parameters import IDENTIFIED, PERIOD, TABLE_2, start_values
from tools.bench import mass_inside
from tools.build import build_fmu
from tools.project import ROOT

FOLDER = ROOT / "docs" / "pictures"
SCENE = start_values(TABLE_2[1], IDENTIFIED)  # row 2: everything vibrates
V_1 = TABLE_2[1].V_1
STILL = {"vibration.V_1": 0.0, "vibration.a_d": 0.0}


def front(fmu: FrictionFmu, path: Path) -> None:
    """The README's mass of 1 kg under 30 N, with and without vibration: steps of 1 ms over those of 10 us."""
    figure, axes = style.subplots(size=(5.2, 3.4))
    pulled = {"V": 0.0, "contact.stiffnessScale": 4.417e-7, "body.m": 1.0, "body.F": 30.0}
    looks = (V_1, style.ORANGE, "with a vibration of 1.44 m/s at 20 kHz"), (0.0, style.BLUE, "without")
    for amplitude, colour, label in looks:
        scene = pulled | {"vibration.V_1": amplitude}
        for step, look in ((1e-5, {"lw": 1.0}), (1e-3, {"marker": "o", "ls": "", "ms": 5, "label": label})):
            run = simulate(fmu, scene, step, round(0.02 / step), outputs=("body.v",))
            axes.plot(1e3 * run["time"], 1e3 * run["body.v"], color=colour, **look)
    axes.set(xlabel="time [ms]", ylabel="velocity of the mass [mm/s]", xlim=(0.0, 20.3), ylim=(None, 460.0))
    axes.set_title("30 N pull 1 kg over a contact with a limit of 55 N")
    axes.legend(loc="upper left", title="dots: steps of 1 ms, lines: of 10 µs", alignment="left")
    style.save(figure, path)


def overview(fmu: FrictionFmu, path: Path) -> None:
    """What the vibration does within microseconds, and what a tool that steps at a millisecond sees of it."""
    figure, (inside, coupled) = style.subplots(2, 1, size=(4.8, 5.6))
    _switched_on(inside, fmu)
    _ramped(coupled, fmu)
    style.save(figure, path)


def _switched_on(axes: Axes, fmu: FrictionFmu) -> None:
    step, before, after = PERIOD / 200, 200, 800
    times, force = [], []
    with fmu.session(SCENE | STILL) as session:
        # Steady sliding, to a time at which the vibration of d passes zero: sigma starts without a jump.
        session.step((100.75 - SCENE["vibration.phase_d"] / (2 * np.pi)) * PERIOD)
        start = session.time
        for k in range(before + after):
            if k == before:
                _vibrate(session, 1.0)
            session.step(step)
            times.append(session.time - start - before * step)
            force.append(session.get("F_t"))
    mean = np.mean(np.reshape(force[before:], (4, 200)), axis=1)
    axes.plot(1e6 * np.array(times), force, color=style.BLUE, lw=2, label="$F_t$")
    axes.hlines(mean, [0, 50, 100, 150], [50, 100, 150, 200], color=style.ORANGE, lw=2.2)
    axes.plot([], [], color=style.ORANGE, lw=2.2, label="its mean over each period")
    axes.axvline(0.0, color=style.GREY, lw=1.0, ls="--")
    axes.set(
        xlabel="time [µs]", ylabel="friction force [N]", title="Vibration of 20 kHz switched on at t = 0"
    )
    axes.set(xlim=(-50.0, 200.0), ylim=(0.0, 1.05 * max(force)))
    axes.legend(loc="upper right")


def _vibrate(session: Session, part: float) -> None:
    for name in STILL:
        session.set(name, part * SCENE[name])


def _ramped(axes: Axes, fmu: FrictionFmu) -> None:
    """V_1 and a_d rise to their full values and back, and each millisecond is one communication step."""
    step, count = 1.01e-3, 60
    share = np.clip(1.5 * np.sin(np.pi * np.arange(count + 1) / count) ** 2, 0.0, 1.0)
    rows = []
    with fmu.session(SCENE | STILL, start=-step) as session:
        session.step(step)
        for part in share[1:]:
            _vibrate(session, part)
            session.step(step)
            rows.append((session.time, session.get("F_t"), session.get("F_t_mean")))
    time, sample, mean = np.array(rows).T
    amplitude = axes.twinx()
    amplitude.fill_between(1e3 * time, share[1:] * V_1, step="pre", color=style.LIGHT, alpha=0.45, lw=0)
    amplitude.set(ylim=(0.0, 6.0), yticks=[0.0, V_1])
    amplitude.set_ylabel("$V_1$ [m/s]", y=0.12)
    amplitude.grid(visible=False)
    axes.set_zorder(amplitude.get_zorder() + 1)
    axes.patch.set_visible(False)
    axes.plot(1e3 * time, sample, "o", color=style.BLUE, ms=3.5, mfc="white", label="$F_t$: a sample")
    axes.plot(1e3 * time, mean, color=style.ORANGE, lw=2.4, label="its mean over the step")
    axes.set(xlabel="time [ms]", ylabel="friction force [N]", title="The same contact in steps of 1.01 ms")
    axes.set(xlim=(0.0, 1e3 * time[-1]), ylim=(0.0, 95.0), yticks=[0, 20, 40, 60, 80])
    axes.legend(loc="upper center", ncols=2)


def fmpy_example(fmu: FrictionFmu, path: Path) -> None:
    """The result of the README's `fmpy simulate`: the default experiment from rest."""
    run = simulate(fmu, SCENE, 5e-7, 400)
    time = 1e6 * run["time"]
    figure, (force, stiffness, work) = style.subplots(3, 1, size=(5.2, 5.6), sharex=True)
    force.plot(time, run["F_t"], lw=2.0, label="F_t")
    force.plot(time, run["F_t_mean"], lw=1.0, label="F_t_mean")
    stiffness.plot(time, 1e-6 * run["sigma"], lw=2.0, label="sigma")
    work.plot(time, 1e3 * run["W_f"], lw=2.0, label="W_f")
    force.set(ylabel="force [N]", ylim=(None, 72.0))
    stiffness.set(ylabel="stiffness [MN/m]", ylim=(None, 10.5))
    work.set(ylabel="work [mJ]", xlabel="time [µs]", xlim=(0.0, time[-1]))
    for axes, place in ((force, "upper right"), (stiffness, "upper right"), (work, "upper left")):
        axes.legend(loc=place, ncols=2)
    style.save(figure, path)


def step_sizes(fmu: FrictionFmu, path: Path) -> None:
    """Where F_t and F_t_mean lie after a step, at any phase, against the length of the step."""
    figure, axes = style.subplots(size=(5.2, 4.4))
    steps = np.geomspace(0.02, 20.0, 241) * PERIOD
    phases = 60
    values = np.empty((len(steps), phases, 2))
    with fmu.session(SCENE | SETTLED) as session:
        for k, step in enumerate(steps):
            for phase in range(phases):
                session.step(PERIOD * (np.ceil(session.time / PERIOD) + phase / phases) - session.time)
                session.step(step)
                values[k, phase] = session.read(("F_t", "F_t_mean"))
    looks = ("F_t", style.SKY, 0.35), ("F_t_mean", style.ORANGE, 0.75)
    for (name, colour, strength), *ends in zip(
        looks, values.min(axis=1).T, values.max(axis=1).T, strict=True
    ):
        axes.fill_between(1e6 * steps, *ends, color=colour, alpha=strength, lw=0, label=name)
    exact = table2.mean_force(fmu, TABLE_2[1], IDENTIFIED)
    axes.axhline(exact, color=style.BLACK, lw=1.0, label=f"mean of the periodic state, {exact:.2f} N")
    axes.set_xscale("log")
    for part, words in ((1 / 20, "1/20 of a period"), (1 / 2, "half a period")):
        axes.axvline(1e6 * part * PERIOD, color=style.BLACK, lw=1.0, ls="--")
        axes.text(1.07e6 * part * PERIOD, 62.5, words, fontsize=8.5, va="center")
    for place, text in ((1.6, "use F_t"), (7.9, "F_t or\nF_t_mean"), (160.0, "use F_t_mean")):
        axes.text(place, 55.0, text, ha="center", va="center", fontsize=9)
    axes.set(ylim=(0.0, 66.0), xlim=1e6 * steps[[0, -1]], ylabel="force after a step, at any phase [N]")
    axes.set_xticks([1, 10, 50, 100, 500, 1000], ["1", "10", "50", "100", "500", "1000"])
    axes.set_xlabel("communication step [µs]; T = 50 µs")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    style.save(figure, path)


def draw_tutorial(folder: Path) -> list[Path]:
    """The pictures that the pages of the tutorial save, by their own blocks, with the package's FMU."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="tutorial-") as temporary:
        for page in PAGES:
            code, _ = blocks(page)
            subprocess.run([sys.executable, "-c", code], cwd=temporary, check=True, stdout=subprocess.DEVNULL)
        return [Path(shutil.copy(path, folder)) for path in sorted(Path(temporary).glob("*.png"))]


def draw(fmu: FrictionFmu, folder: Path) -> list[Path]:
    """All pictures; gives their paths."""
    drawings: dict[str, Callable[[Path], None]] = {
        "table2": partial(table2.draw, fmu, list(table2.results(fmu))),
        "front": partial(front, fmu),
        "overview": partial(overview, fmu),
        "fmpy_example": partial(fmpy_example, fmu),
        "output-choice": diagrams.draw_choice,
        "promise-domain": diagrams.draw_domain,
        "levels": partial(diagrams.draw_levels, fmu),
        "mass-inside": partial(mass_inside.draw, fmu),
        "step_sizes": partial(step_sizes, fmu),
        "physics-open-contact": partial(laws.open_contact, fmu),
        "physics-static-friction": partial(laws.static_friction, fmu),
        "solver-spans": solver.draw_spans,
        "solver-controller": solver.draw_controller,
        "solver-jump": partial(solver.draw_jump, fmu),
        "solver-panels": march.draw_panels,
        "solver-regimes": march.draw_regimes,
        "solver-period": partial(march.draw_map, fmu),
        "three-directions": partial(directions.draw, fmu),
    }
    paths = {folder / f"{name}.png": drawing for name, drawing in drawings.items()}
    for path, drawing in paths.items():
        drawing(path)
    return list(paths)


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/pictures", __doc__)
    add_fmu(parser)
    add_output(parser, FOLDER)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    with FrictionFmu(options.fmu or build_fmu()) as fmu:
        print(*draw(fmu, options.output), sep="\n")
    print(*draw_tutorial(options.output / "tutorial"), sep="\n")
