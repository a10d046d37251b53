"""A slow plant over a 20 kHz contact: 1 ms steps that couple F_t_mean, against the finely resolved system.

The vibration is inside FrictionContact.fmu; the slider and its drive know nothing of it. The reference is
scipy's LSODA on the whole system with every period resolved; it shares nothing with the FMUs.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from scipy.integrate import odeint

from examples.systems import parameters, run_libcosim, write_ssp
from frictioncontact import style
from frictioncontact.errors import UserError
from frictioncontact.parameters import E_REDUCED, SEPARATION
from tools.build import build_fmu
from tools.project import ROOT
from tools.reference import rest, scene_of

HERE = Path(__file__).resolve().parent
DURATION = 0.1  # s
SIGNALS = (("slider", "x"), ("slider", "v"), ("slider", "F"))
STEPS_NS = (5_000_000, 2_000_000, 1_000_000, 500_000, 200_000, 100_000, 50_000)
RESOLVED_NS = 1_250  # 40 steps a period


def description(force: str = "F_t_mean") -> str:
    """The system with this output of the contact as the force on the slider."""
    text = (HERE / "SystemStructure.ssd").read_text()
    return text.replace('startConnector="F_t_mean"', f'startConnector="{force}"')


def make_ssp(fmu: Path, folder: Path, force: str = "F_t_mean") -> Path:
    """fmu: FrictionContact.fmu; MassOnBelt.fmu lies in examples/ beside it."""
    return write_ssp(
        description(force), [fmu, fmu.parent / "examples" / "MassOnBelt.fmu"], folder / f"slider-{force}.ssp"
    )


@cache
def reference(duration: float = DURATION, points: int = 2001) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], and x [m], v [m/s] and impulse of the friction [N s] there, with every period resolved."""
    p = {name: value for (_, name), value in parameters(description()).items()}
    m, k, c, F_C = (p[name] for name in ("m", "k", "c", "F_C"))
    w, phase = 2 * np.pi * p["vibration.f"], p["vibration.phase_d"]
    # sigma = E A_r(d)^2 / d^3, and A_r falls as exp(-3 d / R_q).
    sigma_0 = p["contact.stiffnessScale"] * rest(scene_of({"d": SEPARATION, "E": E_REDUCED}))[1]

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, v, delta, _ = y.tolist()
        V = p["belt.V_0"] - v + p["vibration.V_1"] * math.cos(w * t)
        d = SEPARATION + p["vibration.a_d"] * math.cos(w * t + phase)
        sigma = sigma_0 * math.exp(-6.0 * (d - SEPARATION) / 6e-6) * (SEPARATION / d) ** 3
        F = sigma * delta
        return [v, (F - k * x - c * v) / m, V - sigma * abs(V) * delta / F_C, F]

    times = np.linspace(0.0, duration, points)
    start, scale = [p["x_0"], 0.0, p["delta_0"], 0.0], np.array([1e-3, 1e-1, 1e-5, 1e-2])
    how = {"rtol": 1e-7, "atol": 1e-8 * scale, "hmax": 0.1 * 5e-5, "mxstep": 10_000}
    y = odeint(rates, start, times, tfirst=True, **how)
    return times, y.T[[0, 1, 3]]


def errors(run: dict[tuple[str, str], np.ndarray], step: float) -> float:
    """Largest error of the position against the resolved system, over its static deflection F_C / k."""
    times, y = reference()
    ends = step * np.arange(1, len(run["slider", "x"]) + 1)
    return float(np.abs(run["slider", "x"] - np.interp(ends, times, y[0])).max() / 2.75e-3)


def coupled(ssp: Path, step_ns: int) -> tuple[dict[tuple[str, str], np.ndarray], float]:
    """Run by libcosim over DURATION, and the seconds that it took."""
    begin = time.perf_counter()
    run = run_libcosim(ssp, step_ns, round(DURATION * 1e9) // step_ns, SIGNALS)
    return run, time.perf_counter() - begin


def draw(
    runs: dict[str, tuple[float, dict]], steps: Sequence[float], found: Sequence[float], path: Path
) -> None:
    figure, (force, position, error) = style.subplots(3, 1, size=(5.2, 8.6))
    times, y = reference()
    window = 40  # points of the reference in 2 ms
    mean = (y[2][window:] - y[2][:-window]) / (times[window] - times[0])
    force.plot(1e3 * times[window // 2 : -window // 2], mean, color=style.BLUE, lw=3, alpha=0.5,
               label="every period resolved (mean over 2 ms)")  # fmt: skip
    position.plot(1e3 * times, 1e3 * y[0], color=style.BLUE, lw=3, alpha=0.5, label="every period resolved")
    colours = {"F_t_mean": style.ORANGE, "F_t": style.PINK}
    for name, (step, run) in runs.items():
        ends = step * np.arange(1, len(run["slider", "x"]) + 1)
        label = f"1 ms steps, {name} coupled"
        force.step(1e3 * ends, run["slider", "F"], where="pre", color=colours[name], lw=1.2, label=label)
        position.plot(1e3 * ends, 1e3 * run["slider", "x"], ".-", color=colours[name], lw=1.0, label=label)
    force.set_ylabel("friction force [N]")
    position.set(ylabel="position behind the drive [mm]", ylim=(0.0, 3.9))
    position.set_xlabel("time after the ultrasound is switched on [ms]")
    error.loglog(
        steps, found, "o-", color=style.ORANGE, label="F_t_mean coupled: largest error of x over F_C/k"
    )
    error.loglog(
        steps, [found[-1] * h / steps[-1] for h in steps], "--", color=style.GREY, lw=1, label="slope 1"
    )
    error.axvline(5e-5, color=style.GREY, lw=1, ls=":")
    style.note(error, "one period", x=0.055, y=0.5)
    error.set_xlabel("communication step [s]")
    error.set_ylabel("error against the resolved system")
    for panel in (force, position, error):
        panel.legend()
    style.save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(prog="examples/ultrasonic-slider/run", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="without the co-simulation at 40 steps a period")
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "examples" / "slider", help="folder")
    options = parser.parse_args()
    try:
        run_example(build_fmu(), options)
    except UserError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        sys.exit(f"error: {error.filename or options.output}: {error.strerror or error}")
    print(f"\nwrote ultrasonic-slider.png and the .ssp files to {options.output}")


def run_example(fmu: Path, options: argparse.Namespace) -> None:
    ssp = make_ssp(fmu, options.output)
    sampled = make_ssp(fmu, options.output, "F_t")
    print(f"{'coupled':>10}{'step':>12}{'error of x over F_C/k':>24}{'seconds':>10}")
    steps, found, runs = [], [], {}
    jobs = [("F_t_mean", ssp, step) for step in STEPS_NS] + [("F_t", sampled, 1_000_000)]
    if not options.quick:
        jobs.append(("F_t", sampled, RESOLVED_NS))
    for name, system, step_ns in jobs:
        run, seconds = coupled(system, step_ns)
        error = errors(run, step_ns * 1e-9)
        print(f"{name:>10}{step_ns * 1e-6:>9g} ms{error:>24.2e}{seconds:>10.3f}")
        if name == "F_t_mean":
            steps.append(step_ns * 1e-9)
            found.append(error)
        if step_ns == 1_000_000:
            runs[name] = 1e-3, run
    draw(runs, steps, found, options.output / "ultrasonic-slider.png")


if __name__ == "__main__":
    main()
