"""Calibrates two parameters to a measured force by CasADi's gradient, in model exchange.

The measurement is a run of co-simulation with the true values. Needs casadi besides the package.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
from fmpy import extract

import frictioncontact as fc

SCENE = {"V": 0.5, "vibration.V_1": 1.44}
TRUTH = {"F_C": 48.0, "contact.stiffnessScale": 6e-7}
GUESS = {"F_C": 55.0, "contact.stiffnessScale": 4.4e-7}
STEP, STOP = 2.5e-6, 1e-4  # s, two periods of the vibration
SIZE = ca.DM([1e-2, 1e-5, 1e-2, 1e-5])  # J, m: of the states W_f, delta, Q_f, delta_y


def forces(values: ca.MX) -> ca.MX:
    """F_t [N] after each step, as a function of the parameters over their guesses."""
    dae = ca.DaeBuilder("contact", str(extract(str(fc.FMU))))
    for name, value in (SCENE | GUESS).items():
        dae.set(name, value)
    contact = dae.create("contact", ["t", "x", "p"], ["ode", "y"])
    t, x, parameters = ca.MX.sym("t"), ca.MX.sym("x", 4), ca.MX(ca.DM(dae.get(dae.p())))
    for k, name in enumerate(GUESS):
        parameters[dae.p().index(name)] *= values[k]
    times = np.arange(STEP, STOP + STEP / 2, STEP)
    p = ca.MX.sym("p", len(dae.p()))
    ode = {"t": t, "x": x, "p": p, "ode": contact(t, SIZE * x, p)[0] / SIZE}
    options = {"reltol": 1e-10, "abstol": 1e-10, "max_num_steps": 100_000}
    states = ca.integrator("states", "cvodes", ode, 0.0, times, options)(x0=np.zeros(4), p=parameters)["xf"]
    rows = [contact(time, SIZE * states[:, k], parameters)[1] for k, time in enumerate(times)]
    return ca.vertcat(*(row[dae.y().index("F_t")] for row in rows))


def calibrate(model: Callable[[ca.MX], ca.MX], measured: np.ndarray, steps: int = 8) -> dict[str, float]:
    """By Gauss and Newton."""
    unknown = ca.MX.sym("unknown", len(GUESS))
    misfit = model(unknown) - measured
    both = ca.Function("both", [unknown], [misfit, ca.jacobian(misfit, unknown)])
    found = np.ones(len(GUESS))
    for _ in range(steps):
        residual, slopes = map(np.array, both(found))
        found -= np.linalg.lstsq(slopes, residual.ravel())[0]
    return {name: GUESS[name] * value for name, value in zip(GUESS, found, strict=True)}


if __name__ == "__main__":
    run = fc.simulate(SCENE | TRUTH, stop=STOP, step=STEP, outputs=["F_t"])
    for name, value in calibrate(forces, run["F_t"].to_numpy()[1:]).items():
        print(f"{name} {value:.9g}, in truth {TRUTH[name]:.9g}")
