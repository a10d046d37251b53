"""A mass on a contact that sticks or vibrates: the error of each master, for the table of docs/machine.md.

    .venv/bin/python -m tools.bench.machine      prints the table

    m v' = P(t) - F_t,      V = v

The contact is that of the tutorial, ElasticPlastic. Without vibration the pull P swings, and the mass sticks
between its slides; with it the pull is constant. The error is the largest of v over the largest v.
"""

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from frictioncontact import ModelExchange, friction_law
from frictioncontact.advice.stuck_mass import GAUSS_SEIDEL, JACOBI, LINEAR, least_damping
from frictioncontact.fmu import FrictionFmu, Value
from tools.build import build_fmu

M, SIGMA, F_C, F, V_1 = 1.1, 7.755e6, 2.93, 26e3, 0.0572  # kg, N/m, N, Hz, m/s
PERIOD, END = 1.0 / F, 0.1  # s
CONTACT: dict[str, Value] = {
    "V": 0.0,
    "F_C": F_C,
    "friction.model": "ElasticPlastic",
    "contact.model": "Constant",
    "contact.sigma": SIGMA,
    "vibration.f": F,
}
MODEL_EXCHANGE, OWN = "model exchange", "own solver"
# Master, vibration, output, step [s], whether sigma_1 damps a mass that may stick.
ROWS = (
    (GAUSS_SEIDEL, False, "F_t", 1e-4, True),
    (LINEAR, False, "F_t", 1e-4, True),
    (JACOBI, False, "F_t", 1e-4, True),
    (GAUSS_SEIDEL, True, "F_t_mean", PERIOD, True),
    (GAUSS_SEIDEL, True, "F_t_mean", 10 * PERIOD, False),
    (JACOBI, True, "F_t_mean", PERIOD, True),
)


def pull(t: float, vibrates: bool) -> float:
    """[N], by which the mass slides."""
    return 1.0 if vibrates else 4.0 * math.sin(2.0 * math.pi * 10.0 * t)


@cache
def reference(vibrates: bool) -> Callable[[np.ndarray], np.ndarray]:
    """v [m/s] at times: mass and bristle by leapfrog in steps of 1/1000 period, cut at the limit."""
    count = round(END / PERIOD) * 1000
    h, most = END / count, F_C / SIGMA
    v, delta = np.zeros(count + 1), 0.0
    for k in range(count):
        v[k + 1] = v[k] + h * (pull((k + 0.0) * h, vibrates) - SIGMA * delta) / M
        swing = V_1 * math.cos(2.0 * math.pi * F * (k + 0.5) * h) if vibrates else 0.0
        delta = min(max(delta + h * (v[k + 1] + swing), -most), most)
    return lambda t: np.interp(t, h * (np.arange(count + 1) - 0.5), v)


def scene(vibrates: bool) -> dict[str, Value]:
    return CONTACT | {"vibration.V_1": V_1 if vibrates else 0.0}


def damping(master: str, output: str, H: float) -> float:
    """sigma_1 [N s/m] for a mass that sticks; if the master reads F_t_mean, H sigma/2 more, and a tenth."""
    least = least_damping(M, SIGMA, master, H)
    assert least is not None, (master, H)
    return least + (0.55 * H * SIGMA if output == "F_t_mean" else 0.0)


def exchange(fmu: FrictionFmu, master: str, vibrates: bool, output: str, H: float, sigma_1: float) -> float:
    """The error of a master that exchanges values at its steps, from the force 0 on."""
    v, force, speeds = 0.0, 0.0, []
    with fmu.session(scene(vibrates) | {"friction.sigma_1": sigma_1}) as session:
        for k in range(int(END / H)):
            rate = 0.0
            session.set("V", v)
            acceleration = (pull((k + 0.5) * H, vibrates) - force) / M
            if master == LINEAR:
                session.set_rates(V=acceleration)
                rate = session.force_rate()
            v += H * acceleration - 0.5 * H * H * rate / M
            if master == GAUSS_SEIDEL:
                session.set("V", v)
            session.step(H)
            force = session.get(output)
            speeds.append(v)
    return error(H * np.arange(1, len(speeds) + 1), speeds, vibrates)


def error(times: np.ndarray, speeds: Sequence[float], vibrates: bool) -> float:
    truth = reference(vibrates)(times)
    return float(np.abs(speeds - truth).max() / np.abs(truth).max())


def by_exchange(fmu: FrictionFmu, vibrates: bool, tolerance: float) -> float:
    """The error of an integrator that takes mass and bristle together."""
    times, speeds = np.linspace(0.0, END, 501)[1:], []
    with ModelExchange(
        scene(vibrates),
        own=(0.0,),
        inputs=lambda t, own: {"V": own[0]},
        rates=lambda t, own, F_t: ((pull(t, vibrates) - F_t) / M,),
        nominals=(0.01,),
        tolerance=tolerance,
        fmu=fmu,
    ) as host:
        for t in times:
            host.advance(t)
            speeds.append(host.own[0])
    return error(times, speeds, vibrates)


def by_law() -> float:
    """The error of a solver of one's own with the settled friction: no bristle, no period."""
    law, times = friction_law(scene(True)), np.linspace(0.0, END, 501)[1:]
    run = solve_ivp(lambda t, v: (pull(t, True) - law(v)) / M, (0.0, END), [0.0], t_eval=times, max_step=2e-3)
    return error(times, run.y[0], True)


def main() -> None:
    with FrictionFmu(build_fmu()) as fmu:
        for master, vibrates, output, H, sticks in ROWS:
            sigma_1 = damping(master, output, H) if sticks else 0.0
            found = exchange(fmu, master, vibrates, output, H, sigma_1)
            show(master, vibrates, output, H, found, sigma_1)
        for vibrates in (False, True):
            show(MODEL_EXCHANGE, vibrates, "F_t", 1e-6, by_exchange(fmu, vibrates, 1e-6))
        show(OWN, True, "F_t_settled", 2e-3, by_law())


def show(master: str, vibrates: bool, output: str, H: float, found: float, sigma_1: float = 0.0) -> None:
    """H: the step [s], or the tolerance."""
    on = "on" if vibrates else "off"
    print(f"{master:18}{on:5}{output:13}{H:10.2g}{sigma_1:8.4g}{100 * found:10.2g} %")


if __name__ == "__main__":
    main()
