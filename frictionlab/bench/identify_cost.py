"""What the fit of Table 2 costs in scripts/identify, against a fit through one open session of the FMU a row.

The latter is how release 0.1.0 did it: scipy's least squares from the best 8 of 256 points, 20 000 periods of
settling for each mean, a tolerance of 1e-9. Both take turns in one run; the ratios hold on any machine.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

from frictionlab.build import build_fmu
from frictionlab.command import finish
from frictionlab.fmu import FrictionFmu
from frictionlab.identify.bootstrap import bootstrap
from frictionlab.identify.command import EXAMPLE
from frictionlab.identify.data import read
from frictionlab.identify.experiment import Rows
from frictionlab.identify.fit import fit, fits
from frictionlab.identify.parameter import Parameter, parameter
from frictionlab.project import UserError

NAMES = ("contact.stiffnessScale", "vibration.phase_d")
SETTLING, TOLERANCE, POINTS, STARTS, DIFFERENCE = 20_000, 1e-9, 256, 8, 1e-4
REFITS = 1000


def by_sessions(fmu: FrictionFmu, parameters: Sequence[Parameter]) -> np.ndarray:
    """The fitted values."""
    rows = read(EXAMPLE, fmu, {})
    sessions = [fmu.session({**row, "solver.tolerance": TOLERANCE}) for row in rows.conditions]
    period = 1.0 / sessions[0].get("vibration.f")

    def residuals(x: np.ndarray) -> np.ndarray:
        means = []
        for session in sessions:
            for p, coordinate in zip(parameters, x, strict=True):
                session.set(p.name, p.to_value(float(coordinate)))
            session.step(SETTLING * period)
            session.step(period)
            means.append(session.get("F_t_mean"))
        return np.array(means) - rows.force

    low, high = (np.array([p.to_coordinate(p.search[k]) for p in parameters]) for k in (0, 1))
    points = low + (high - low) * qmc.Sobol(len(parameters), scramble=False).random(POINTS)
    best = np.argsort([np.sum(residuals(point) ** 2) for point in points])[:STARTS]
    bounds = ([p.to_coordinate(p.low) for p in parameters], [p.to_coordinate(p.high) for p in parameters])
    found = [
        least_squares(residuals, points[k], bounds=bounds, diff_step=DIFFERENCE, xtol=1e-10, ftol=1e-10)
        for k in best
    ]
    for session in sessions:
        session.close()
    least = min(found, key=lambda one: one.cost)
    return np.array([p.to_value(x) for p, x in zip(parameters, least.x, strict=True)])


def seconds(run: Callable[[], object]) -> float:
    began = time.process_time()
    run()
    return time.process_time() - began


def measure(fmu: FrictionFmu, turns: int) -> None:
    parameters = [parameter(fmu, name, None, None, {}) for name in NAMES]
    experiment = Rows(fmu, read(EXAMPLE, fmu, {}), parameters)
    result = fit(experiment)
    old = by_sessions(fmu, parameters)
    if not np.allclose(old, result.values, rtol=1e-3):
        raise UserError(f"the fits differ: {old} and {result.values}")
    runs = {
        "one open session a row": lambda: by_sessions(fmu, parameters),
        "fit with linear intervals": lambda: fits(experiment, experiment.target[None, :]),
        "and profiles, as scripts/identify does": lambda: fit(experiment),
    }
    taken = [[seconds(run) for run in runs.values()] for _ in range(turns)]
    print(f"{'processor time of a fit of Table 2':42}{'ms':>8}{'times faster':>14}")
    for k, name in enumerate(runs):
        ratio = statistics.median(turn[0] / turn[k] for turn in taken)
        print(f"{name:42}{1e3 * statistics.median(turn[k] for turn in taken):8.1f}{ratio:14.1f}")
    print(f"{f'{REFITS} refits':42}{1e3 * seconds(lambda: bootstrap(experiment, result, REFITS)):8.0f}")


def main(argv: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="bench/identify-cost", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="3 turns in place of 25")
    parser.add_argument("--fmu", type=Path, help="FMU to use (the one of build/, built where it is old)")
    try:
        finish(run, parser.parse_args(argv))
    except KeyboardInterrupt:
        sys.exit("stopped")


def run(options: argparse.Namespace) -> None:
    with FrictionFmu(options.fmu or build_fmu()) as fmu:
        measure(fmu, 3 if options.quick else 25)


if __name__ == "__main__":
    main()
