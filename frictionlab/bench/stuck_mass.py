"""A mass held by a stuck contact, and the masters that may exchange force and velocity between them.

    m v' = -c v - F_t,      delta' = V = v,      F_t = sigma delta + sigma_1 V     while the contact sticks

Every master below takes steps of H with values held over a step (but for "Jacobi, linear"), so a step is a
matrix and the exchange is stable where its spectral radius is at most 1. The mass is integrated exactly.

    Jacobi          both sides start from the values at the start of the step; F_t is what the last step of
                    the FMU left, with the velocity that it was given then: libcosim, fmpy's SSP, most tools
    Jacobi, reread  the same, but F_t is read again after the new V has been set
    Jacobi, linear  with the derivatives of V and of F_t
    Gauss-Seidel    the mass goes first, then the contact with the new velocity
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from frictionlab.fmu import FrictionFmu, Value

JACOBI, REREAD, LINEAR, GAUSS_SEIDEL = "Jacobi", "Jacobi, reread", "Jacobi, linear", "Gauss-Seidel"
MASTERS = (JACOBI, REREAD, LINEAR, GAUSS_SEIDEL)


@dataclass(frozen=True)
class StuckMass:
    m: float  # kg
    sigma: float  # N/m, of the contact
    sigma_1: float = 0.0  # N s/m, damping of the bristle
    c: float = 0.0  # N s/m, damping outside

    @property
    def time(self) -> float:
        """1 over the angular frequency of the mass on the contact [s]."""
        return math.sqrt(self.m / self.sigma)


def mass_step(mass: StuckMass, H: float) -> tuple[float, float, float]:
    """v_1 = kept v + by_force F + by_rate F' after a step of H [s] with the force F + F' t."""
    x = mass.c * H / mass.m
    kept = math.exp(-x)
    if x == 0.0:
        return 1.0, -H / mass.m, -0.5 * H**2 / mass.m
    first = -math.expm1(-x) / mass.c
    return kept, -first, -(H - mass.m * first) / mass.c


def step_matrix(mass: StuckMass, master: str, H: float) -> np.ndarray:
    """Of (v, delta, velocity that the contact had in its last step)."""
    sigma, sigma_1 = mass.sigma, mass.sigma_1
    kept, by_force, by_rate = mass_step(mass, H)
    v, delta, last = np.eye(3)
    if master == JACOBI:
        force = sigma * delta + sigma_1 * last
        return np.array([kept * v + by_force * force, delta + H * v, v])
    force = sigma * delta + sigma_1 * v
    if master == REREAD:
        return np.array([kept * v + by_force * force, delta + H * v, v])
    if master == GAUSS_SEIDEL:
        after = kept * v + by_force * force
        return np.array([after, delta + H * after, after])
    acceleration = -(force + mass.c * v) / mass.m
    rate = sigma * v + sigma_1 * acceleration
    after = kept * v + by_force * force + by_rate * rate
    return np.array([after, delta + H * v + 0.5 * H**2 * acceleration, after])


def spectral_radius(mass: StuckMass, master: str, H: float) -> float:
    """Growth per step [1]; 1 at rest is no motion of this system, so nothing is left out."""
    return float(np.abs(np.linalg.eigvals(step_matrix(mass, master, H))).max())


def is_stable(mass: StuckMass, master: str, H: float) -> bool:
    return spectral_radius(mass, master, H) <= 1.0 + 1e-12


def damping_range(m: float, sigma: float, master: str, H: float) -> tuple[float, float] | None:
    """The sigma_1 [N s/m] between which a step of H [s] is stable; None where none is.

    A grid finds a stable one, bisection its ends; the stable ones are an interval for all masters.
    """
    if master == GAUSS_SEIDEL and H >= 2.0 * math.sqrt(m / sigma):
        return None
    grid = np.concatenate([[0.0], m / H * np.logspace(-6.0, 0.6, 2000)])
    stable = [is_stable(StuckMass(m, sigma, damping), master, H) for damping in grid]
    if not any(stable):
        return None
    first, last = stable.index(True), len(stable) - 1 - stable[::-1].index(True)

    def edge(inside: float, outside: float) -> float:
        for _ in range(60):
            middle = 0.5 * (inside + outside)
            if is_stable(StuckMass(m, sigma, middle), master, H):
                inside = middle
            else:
                outside = middle
        return inside

    low = grid[0] if first == 0 else edge(grid[first], grid[first - 1])
    return float(low), float(edge(grid[last], grid[min(last + 1, len(grid) - 1)]))


def best_damping(m: float, sigma: float, master: str, H: float) -> float:
    """The sigma_1 [N s/m] with the least spectral radius at a step of H [s]."""
    span = damping_range(m, sigma, master, H)
    if span is None:
        raise ValueError(f"no sigma_1 makes a step of {H:g} s stable with {master}")
    grid = np.linspace(*span, 400)
    return float(min(grid, key=lambda damping: spectral_radius(StuckMass(m, sigma, damping), master, H)))


def light_damping(m: float, sigma: float, master: str, H: float) -> float:
    """Twice the least stable sigma_1 [N s/m], at most the best: it damps, and changes the motion less."""
    span = damping_range(m, sigma, master, H)
    best = best_damping(m, sigma, master, H)
    return min(2.0 * span[0], best) if span and span[0] > 0.0 else best


def largest_step(m: float, sigma: float, master: str) -> float:
    """The largest step H [s] that some sigma_1 makes stable."""
    low, high = 1e-3 * math.sqrt(m / sigma), 4.0 * math.sqrt(m / sigma)
    for _ in range(40):
        middle = math.sqrt(low * high)
        if damping_range(m, sigma, master, middle) is not None:
            low = middle
        else:
            high = middle
    return low


def advice(m: float, sigma: float, master: str, H: float, start_values: Mapping[str, Value]) -> str:
    """What to set for a mass of m [kg] on a contact of sigma [N/m] and a step of H [s], in words."""
    time = math.sqrt(m / sigma)
    lines = [
        f"The stuck contact, a spring of {sigma:.6g} N/m under {m:g} kg: sqrt(m / sigma) = {time:.6g} s.",
        f"{master}: friction.sigma_1 can make steps up to {largest_step(m, sigma, master):.6g} s stable.",
    ]
    span = damping_range(m, sigma, master, H)
    if span is None:
        lines.append(f"At a step of {H:g} s no friction.sigma_1 does. Take a shorter step, or Gauss-Seidel.")
        return "\n".join(lines)
    lines.append(
        f"At a step of {H:g} s it is stable with friction.sigma_1 from {span[0]:.6g} to {span[1]:.6g} N s/m."
    )
    light, best = (choose(m, sigma, master, H) for choose in (light_damping, best_damping))
    for damping, what in ((light, "changes the motion least"), (best, "damps best")):
        radius = spectral_radius(StuckMass(m, sigma, damping), master, H)
        lines.append(f"{damping:.6g} N s/m {what}: a swing falls to {radius:.3f} of itself in each step.")
    words = " ".join(f"{name} {value}" for name, value in start_values.items())
    lines.append("\n--start-values " + f"{words} friction.sigma_1 {light:.6g}".strip())
    return "\n".join(lines)


def exchange(fmu: FrictionFmu, mass: StuckMass, master: str, H: float, count: int) -> np.ndarray:
    """Velocities [m/s] of the mass at the communication points, started at 1 um/s from rest of the contact.

    The law is ElasticPlastic far below its limit, which sticks truly.
    """
    kept, by_force, by_rate = mass_step(mass, H)
    start = {
        "friction.model": "ElasticPlastic",
        "contact.model": "Constant",
        "contact.sigma": mass.sigma,
        "friction.sigma_1": mass.sigma_1,
        "F_C": 1e9 * mass.sigma * mass.time * 1e-6,
        "V": 1e-6,
    }
    v = 1e-6
    speeds = [v]
    with fmu.session(start) as session:
        for _ in range(count):
            if master == JACOBI:
                force = session.get("F_t")
                session.set("V", v)
            else:
                session.set("V", v)
                force = session.get("F_t")
            rate = 0.0
            if master == LINEAR:
                session.set_rates(V=-(force + mass.c * v) / mass.m)
                rate = session.force_rate()
            v = kept * v + by_force * force + by_rate * rate
            if master == GAUSS_SEIDEL:
                session.set("V", v)
            session.step(H)
            speeds.append(v)
            if not abs(v) < 1e3:
                break
    return np.array(speeds)


def grows(fmu: FrictionFmu, mass: StuckMass, master: str, H: float) -> bool:
    """Whether the swing of the FMU and the mass grows over 600 steps, measured."""
    speeds = np.abs(exchange(fmu, mass, master, H, 600))
    if len(speeds) < 600:
        return True
    return bool(speeds[500:].max() > speeds[300:400].max())


def measured_edge(fmu: FrictionFmu, stable: StuckMass, unstable: StuckMass, master: str, H: float) -> float:
    """The sigma_1, or where both have the same the c, [N s/m] at which the FMU's exchange turns unstable."""
    low, high = stable, unstable
    for _ in range(8):
        middle = StuckMass(low.m, low.sigma, 0.5 * (low.sigma_1 + high.sigma_1), 0.5 * (low.c + high.c))
        if grows(fmu, middle, master, H):
            high = middle
        else:
            low = middle
    return (
        0.5 * (low.sigma_1 + high.sigma_1) if stable.sigma_1 != unstable.sigma_1 else 0.5 * (low.c + high.c)
    )
