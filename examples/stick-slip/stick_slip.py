"""A mass on a belt: an SSP of two FMUs run by libcosim and fmpy, against the whole system solved at once.

The reference shares nothing with the FMUs: scipy's LSODA on position, velocity and bristle deflection
together, with the contact's stiffness from the formulas.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from scipy.integrate import solve_ivp

from examples.systems import parameters, run_fmpy, run_libcosim, with_parameters, write_ssp
from frictioncontact import style
from frictioncontact.advice.stuck_mass import JACOBI, least_damping
from frictioncontact.errors import UserError
from frictioncontact.parameters import E_FULL, SEPARATION
from tools.build import build_fmu
from tools.project import ROOT
from tools.reference import rest, scene_of

HERE = Path(__file__).resolve().parent
DURATION = 1.0  # s, two periods of the belt's unsteadiness
SIGNALS = (("mass", "x"), ("mass", "v"), ("contact", "F_t"))
STEPS_NS = (2_000_000, 1_000_000, 500_000, 200_000, 100_000, 50_000, 20_000, 10_000)


def make_ssp(fmu: Path, output: Path, sigma_1: float = 0.0) -> Path:
    """fmu: FrictionContact.fmu; MassOnBelt.fmu lies in examples/ beside it.

    sigma_1 [N s/m] damps the stuck contact.
    """
    description = (HERE / "SystemStructure.ssd").read_text()
    description = with_parameters(description, {("contact", "friction.sigma_1"): sigma_1})
    return write_ssp(description, [fmu, fmu.parent / "examples" / "MassOnBelt.fmu"], output)


def belt_velocity(time: np.ndarray, p: dict[tuple[str, str], float]) -> np.ndarray:
    return p["mass", "belt.V_0"] + p["mass", "belt.V_1"] * np.sin(2 * np.pi * p["mass", "belt.f"] * time)


@cache
def one_system() -> tuple[Callable[[np.ndarray], np.ndarray], float]:
    """x [m], v [m/s] and delta [m] as a function of time (Eq. 1, 2 and Newton's law), and sigma [N/m]."""
    p = parameters((HERE / "SystemStructure.ssd").read_text())
    m, k, c = (p["mass", name] for name in "mkc")
    F_C = p["contact", "F_C"]
    sigma = p["contact", "contact.stiffnessScale"] * rest(scene_of({"d": SEPARATION, "E": E_FULL}))[1]

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, v, delta = y
        V = belt_velocity(t, p) - v
        return [v, (sigma * delta - k * x - c * v) / m, V - sigma * abs(V) * delta / F_C]

    start = [0.0, p["mass", "v_0"], 0.0]
    scale = np.array([1e-3, 1e-2, 1e-5])
    solution = solve_ivp(
        rates,
        (0.0, DURATION),
        start,
        "LSODA",
        dense_output=True,
        rtol=1e-10,
        atol=1e-10 * scale,
        max_step=1e-3,
    )
    return solution.sol, sigma


def reference(times: np.ndarray) -> np.ndarray:
    """x [m], v [m/s] and F [N] at the times."""
    state, sigma = one_system()
    x, v, delta = state(times)
    return np.array([x, v, sigma * delta])


def measure(ssp: Path, steps_ns: Sequence[int]) -> list[dict[str, float]]:
    """Largest error of the position and root mean square error of the force, for each communication step."""
    p = parameters((HERE / "SystemStructure.ssd").read_text())
    F_C, k = p["contact", "F_C"], p["mass", "k"]
    rows = []
    for step_ns in steps_ns:
        count = round(DURATION * 1e9) // step_ns
        run = run_libcosim(ssp, step_ns, count, SIGNALS)
        x, _, F = reference(step_ns * 1e-9 * np.arange(1, count + 1))
        rows.append(
            {
                "step [s]": step_ns * 1e-9,
                "largest error of x over F_C/k": float(np.abs(run["mass", "x"] - x).max() * k / F_C),
                "rms error of F_t over F_C": float(np.sqrt(np.mean((run["contact", "F_t"] - F) ** 2)) / F_C),
            }
        )
    return rows


def measure_damped(fmu: Path, folder: Path, steps_ns: Sequence[int]) -> list[dict[str, float]]:
    """The same errors against the undamped system, with the friction.sigma_1 advised for each step."""
    p = parameters((HERE / "SystemStructure.ssd").read_text())
    _, sigma = one_system()
    rows = []
    for step_ns in steps_ns:
        sigma_1 = least_damping(p["mass", "m"], sigma, JACOBI, step_ns * 1e-9)
        assert sigma_1 is not None  # below 0.5 sqrt(m / sigma)
        ssp = make_ssp(fmu, folder / f"damped-{step_ns}.ssp", sigma_1)
        rows.append(measure(ssp, [step_ns])[0] | {"sigma_1 [N s/m]": sigma_1})
    return rows


def importers_differ(ssp: Path, step_ns: int = 1_000_000) -> float:
    """Largest difference of F_t between libcosim and fmpy [N]."""
    count = round(DURATION * 1e9) // step_ns
    by_libcosim, by_fmpy = (
        run_libcosim(ssp, step_ns, count, SIGNALS),
        run_fmpy(ssp, step_ns * 1e-9, count, SIGNALS),
    )
    return float(np.abs(by_libcosim["contact", "F_t"] - by_fmpy["contact", "F_t"]).max())


def draw(ssp: Path, rows: list[dict[str, float]], output: Path) -> None:
    figure, axes = style.subplots(3, 1, size=(5.2, 8.6), gridspec_kw={"height_ratios": [1, 1, 1.3]})
    p = parameters((HERE / "SystemStructure.ssd").read_text())
    times = np.linspace(0.0, DURATION, 4001)
    _, v, F = reference(times)
    _shade_sticking(axes[:2], times, np.abs(F) < 0.98 * p["contact", "F_C"])
    axes[0].plot(times, 1e3 * belt_velocity(times, p), color=style.GREY, lw=1.0, label="belt")
    axes[0].plot(times, 1e3 * v, color=style.BLUE, label="mass, one system")
    axes[0].set(ylabel="velocity [mm/s]", ylim=(-45, 105))
    axes[1].plot(times, F, color=style.BLUE, label="one system (scipy LSODA)")
    for step_ns, colour in ((2_000_000, style.AMBER), (200_000, style.ORANGE)):
        count = round(DURATION * 1e9) // step_ns
        run = run_libcosim(ssp, step_ns, count, SIGNALS)
        label = f"libcosim, steps of {step_ns * 1e-6:g} ms"
        axes[1].plot(
            step_ns * 1e-9 * np.arange(1, count + 1), run["contact", "F_t"], color=colour, lw=1.0, label=label
        )
    axes[1].set_ylabel("friction force $F_t$ [N]")
    axes[1].set_xlabel("time [s]; shaded: sticking, $|F_t| < 0.98 F_C$")
    axes[1].set_ylim(-62, 140)
    steps = [row["step [s]"] for row in rows]
    for name, colour in (
        ("largest error of x over F_C/k", style.GREEN),
        ("rms error of F_t over F_C", style.ORANGE),
    ):
        axes[2].loglog(steps, [row[name] for row in rows], "o-", color=colour, label=name)
    last = rows[-1]["largest error of x over F_C/k"]
    axes[2].loglog(
        steps, [last * h / steps[-1] for h in steps], "--", color=style.GREY, lw=1.0, label="slope 1"
    )
    axes[2].set_xlabel("communication step [s]")
    axes[2].set_ylabel("error against one system")
    for panel in axes:
        panel.legend(loc="upper left")
    style.save(figure, output)


def _shade_sticking(panels: Sequence[Axes], times: np.ndarray, sticking: np.ndarray) -> None:
    for panel in panels:
        low, high = 0.0, 1.0
        panel.fill_between(
            times,
            low,
            high,
            where=sticking,
            color=style.LIGHT,
            alpha=0.5,
            lw=0,
            transform=panel.get_xaxis_transform(),
        )


def main() -> None:
    parser = argparse.ArgumentParser(prog="examples/stick-slip/run", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="steps down to 0.1 ms only")
    parser.add_argument(
        "--output", type=Path, default=ROOT / "build" / "examples" / "stick-slip", help="folder"
    )
    options = parser.parse_args()
    try:
        ssp = make_ssp(build_fmu(), options.output / "stick-slip.ssp")
        rows = measure(ssp, STEPS_NS[:5] if options.quick else STEPS_NS)
        print(f"libcosim and fmpy differ by at most {importers_differ(ssp):.1e} N\n")
        print(f"{'step':>10}{'error of x over F_C/k':>24}{'error of F_t over F_C':>24}")
        for step, x, F in (row.values() for row in rows):
            print(f"{step * 1e3:>7g} ms{x:>24.2e}{F:>24.2e}")
        damped = measure_damped(build_fmu(), options.output, STEPS_NS[2 : 5 if options.quick else None])
        print("\nwith friction.sigma_1 as scripts/advise recommends for the step:")
        for step, x, F, sigma_1 in (row.values() for row in damped):
            print(f"{step * 1e3:>7g} ms{x:>24.2e}{F:>24.2e}{sigma_1:>12.4g} N s/m")
        with (options.output / "errors.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        draw(ssp, rows, options.output / "stick-slip.png")
    except UserError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        sys.exit(f"error: {error.filename or options.output}: {error.strerror or error}")
    print(f"\nwrote errors.csv, stick-slip.png and stick-slip.ssp to {options.output}")


if __name__ == "__main__":
    main()
