"""How one method behaves at one z = sigma |V| h / F_C: steady sliding from rest, V and sigma constant.

The force starts at 0 and should rise to F_C without passing it. With e = 1 - F_t / F_C,
    monotone   |e| falls and keeps its sign
    rings      e changes sign from step to step, and falls
    stable     settles at F_C with an e of changing sign that is below the method's own tolerance
    diverges   |e| grows
    refuses    fmi2Error
"""

import numpy as np

from frictioncontact.fmu import FrictionError, FrictionFmu
from frictioncontact.parameters import COULOMB_FORCE, VELOCITY_IDENTIFIED
from workshop.bench.coupling import edge

SIGMA, V, F_C = 2.5e6, VELOCITY_IDENTIFIED, COULOMB_FORCE
STEPS = 40
TOLERANCE = 1e-6
ROUNDING = 1e-12
RK4_LIMIT = 2.785293563405282

FMU_METHODS = ("collocation", "cvode", "backwardEuler", "trapezoid", "rk4", "explicitEuler")
UNCHECKED = {
    "rk4, unchecked": 4,
    "explicitEuler, unchecked": 1,
}  # what an FMU without the check does: its order
METHODS = (*FMU_METHODS, *UNCHECKED)

# Where one behaviour gives way to another, in theory.
EDGES = {
    "trapezoid": {("monotone", "rings"): 2.0},
    "rk4": {("monotone", "refuses"): RK4_LIMIT},
    "explicitEuler": {("monotone", "rings"): 1.0, ("rings", "refuses"): 2.0},
    "rk4, unchecked": {("monotone", "diverges"): RK4_LIMIT},
    "explicitEuler, unchecked": {("monotone", "rings"): 1.0, ("rings", "diverges"): 2.0},
}


def forces(fmu: FrictionFmu, method: str, z: float) -> np.ndarray:
    """F_t / F_C after each step of h = z F_C / (sigma V)."""
    h = z * F_C / (SIGMA * V)
    if method in UNCHECKED:
        return _unchecked(UNCHECKED[method], z)
    start = {
        "V": V,
        "contact.model": "Constant",
        "contact.sigma": SIGMA,
        "solver.method": method,
        "solver.stepSize": h,
        "solver.tolerance": TOLERANCE,
    }
    values = []
    with fmu.session(start) as session:
        for _ in range(STEPS):
            session.step(h)
            values.append(session.get("F_t"))
    return np.array(values) / F_C


def _unchecked(order: int, z: float) -> np.ndarray:
    """The same explicit steps of y' = 1 - y from 0, in z."""
    y, values = 0.0, []
    for _ in range(STEPS):
        k = z * (1.0 - y)
        if order == 4:
            k_2 = z * (1.0 - (y + k / 2))
            k_3 = z * (1.0 - (y + k_2 / 2))
            k_4 = z * (1.0 - (y + k_3))
            k = (k + 2 * k_2 + 2 * k_3 + k_4) / 6
        y += k
        values.append(y)
        if abs(y) > 1e100:
            break
    return np.array(values)


def classify(fmu: FrictionFmu, method: str, z: float) -> str:
    try:
        error = 1.0 - forces(fmu, method, z)
    except FrictionError:
        return "refuses"
    error = np.concatenate([[1.0], error])
    size = np.abs(error)
    noise = TOLERANCE if method == "cvode" else ROUNDING
    seen = size > noise
    if size[-1] > size[0] or size[1] > size[0]:
        return "diverges"
    overshoots = (error < -noise).any()
    if overshoots:
        return "rings"
    falls = (np.diff(size)[seen[1:]] < 0).all()
    return "monotone" if falls and not (error < -ROUNDING).any() else "stable"


def measured_edge(fmu: FrictionFmu, method: str, before: str, theory: float) -> float:
    """Bisection for the z up to which the behaviour is the one before the edge."""
    low, high = 0.75 * theory, 1.4 * theory
    if classify(fmu, method, low) != before or classify(fmu, method, high) == before:
        raise ValueError(f"{method} has no edge from {before} between z = {low:.3g} and {high:.3g}")
    return edge(lambda z: classify(fmu, method, z) == before, low, high, 2e-4)
