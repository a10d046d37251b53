"""A mass held by a stuck contact, and the masters that may exchange force and velocity between them.

    m v' = -F_t,      delta' = V = v,      F_t = sigma delta + sigma_1 V     while the contact sticks

Every master below takes steps of H with values held over a step (but for "Jacobi, linear"), so a step is an
affine map, and the exchange is stable where the eigenvalues of its matrix are at most 1.

    Jacobi          both sides start from the values at the start of the step; F_t is what the last step of
                    the FMU left, with the velocity that it was given then: libcosim, fmpy's SSP
    Jacobi, reread  the same, but F_t is read again after the new V has been set
    Jacobi, linear  the same with the derivatives: V, F_t and then F_t' are exchanged before the step
    Gauss-Seidel    the mass goes first, then the contact with the new velocity

"inside" is body.m: the FMU moves the mass, and any master is stable at any step.

With a = H^2 sigma / m and b = H sigma_1 / m the eigenvalues x are the roots of

    Jacobi          x^3 - 2 x^2 + (1 + a + b) x - b          on the unit circle at  b - b^2 = a
    Jacobi, reread  x^2 - (2 - b) x + 1 + a - b              b = a,  b = 2 + a / 2
    Jacobi, linear  x^2 - (2 - a - b + b^2 / 2) x + D        D = 1,  b = 2 + a / 2
                    D = 1 + a^2 / 4 - b - a b / 2 + b^2 / 2
    Gauss-Seidel    x^2 - (2 - a - b) x + 1 - b              b = 0,  b = 2 - a / 2

F_t_mean of the last step is sigma delta + (sigma_1 - H sigma / 2) V. So it adds a / 2 to b at both edges of
Jacobi and Gauss-Seidel.
"""

import math
from collections.abc import Mapping
from typing import Literal

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Session, Value
from frictioncontact.values import real

Master = Literal["Jacobi", "Jacobi, reread", "Jacobi, linear", "Gauss-Seidel", "inside"]
INSIDE: Master = "inside"
MASTERS: tuple[Master, ...] = ("Jacobi", "Jacobi, reread", "Jacobi, linear", "Gauss-Seidel")
JACOBI, REREAD, LINEAR, GAUSS_SEIDEL = MASTERS
# The largest H sqrt(sigma / m) that some sigma_1 makes stable: there the two edges meet.
LARGEST_STEP = {JACOBI: 0.5, REREAD: 2.0, LINEAR: math.sqrt(2.0 + math.sqrt(8.0)), GAUSS_SEIDEL: 2.0}
MASSES = (1e-12, 1e12)  # kg
ZETAS = (0.1, 0.5)  # damping ratios of a contact that rings under a mass inside
MARGIN = 1.1  # of the advised sigma_1 over the smallest stable one, at which a swing never dies out


def damping_range(m: float, sigma: float, master: str, H: float) -> tuple[float, float] | None:
    """The sigma_1 [N s/m] between which a step of H [s] is stable; None where none is.

    m in kg, sigma in N/m. The edges are those of the head of this file.
    """
    a = H / m * H * sigma
    if math.sqrt(a) > LARGEST_STEP[master]:
        return None
    if master == JACOBI:
        root = math.sqrt(max(1.0 - 4.0 * a, 0.0))
        low, high = 2.0 * a / (1.0 + root), (1.0 + root) / 2.0
    elif master == REREAD:
        low, high = a, 2.0 + a / 2.0
    elif master == LINEAR:
        root = math.sqrt(max(1.0 + a - a**2 / 4.0, 0.0))
        low, high = a**2 / 2.0 / (1.0 + a / 2.0 + root), 1.0 + a / 2.0 + min(1.0, root)
    else:
        low, high = 0.0, 2.0 - a / 2.0
    return m / H * low, m / H * high


def least_damping(m: float, sigma: float, master: str, H: float) -> float | None:
    """The smallest stable sigma_1 [N s/m] and a tenth; 0 where none is needed, None where none is stable."""
    span = damping_range(m, sigma, master, H)
    return None if span is None else min(MARGIN * span[0], math.sqrt(span[0] * span[1]))


def advice(m: float, sigma: float, master: str, H: float) -> tuple[str, dict[str, Value]]:
    """What to set for a mass of m [kg] on a contact of sigma [N/m] and a step of H [s]: words and values."""
    time = math.sqrt(m / sigma)
    lines = [
        f"The stuck contact is a spring of {sigma:.6g} N/m under {m:g} kg: sqrt(m / sigma) = {time:.6g} s.",
        f"{master}: friction.sigma_1 can make steps up to {LARGEST_STEP[master] * time:.6g} s stable.",
    ]
    span, damping = damping_range(m, sigma, master, H), least_damping(m, sigma, master, H)
    if span is None or damping is None:
        lines.append(f"No friction.sigma_1 makes a step of {H:g} s stable.")
        lines.append(
            f"Set body.m = {m:g}: the FMU then moves the mass, stable at every step (master: inside)."
        )
        lines.append(f"Or take Gauss-Seidel, in steps up to {LARGEST_STEP[GAUSS_SEIDEL] * time:.6g} s.")
        return "\n".join(lines), {}
    lines.append(f"At a step of {H:g} s it is stable from {span[0]:.6g} to {span[1]:.6g} N s/m.")
    if damping == 0.0:
        lines.append("F_t needs no damping. friction.sigma_1 = 0 has its smallest error.")
    else:
        lines += [
            f"Set {damping:.6g} N s/m, the smallest stable value plus 10 %.",
            "A larger value increases the error.",
            "It adds sigma_1 der(delta) to F_t. Under a vibration F_t may then swing by many times F_C,",
            "though its mean stays. Set it only if the mass sticks.",
            f"At break-away F_t exceeds the static friction by sigma_1 V, {damping:.6g} N for each m/s.",
            "If that matters, take Gauss-Seidel, which needs no damping for F_t.",
        ]
    if master in (JACOBI, GAUSS_SEIDEL):
        lines.append(
            f"If you read F_t_mean, add H sigma / 2 = {H * sigma / 2:.6g} N s/m to each of these values."
        )
    return "\n".join(lines), {"friction.sigma_1": float(f"{damping:.6g}")}


def advice_inside(
    m: float, sigma: float, H: float, scene: Mapping[str, Value]
) -> tuple[str, dict[str, Value]]:
    """The same for a mass inside the FMU, which needs no damping; but of its ringing F_t is a sample."""
    rad = math.sqrt(sigma / m)
    low, high = (float(f"{2.0 * zeta * math.sqrt(sigma * m):.6g}") for zeta in ZETAS)
    lines = [
        f"body.m = {m:g}: the FMU moves the mass by body.F, so every master is stable at every step.",
        "Let the master send the derivative of body.F too: held forces are its largest error.",
        "V is the velocity of the other surface, without the mass: 0 if that surface stands.",
    ]
    values: dict[str, Value] = {"V": 0.0, "body.m": m} if "V" not in scene else {"body.m": m}
    if scene.get("friction.model") == "Coulomb":
        lines.append("Coulomb friction holds the mass rigidly, and nothing rings.")
        return "\n".join(lines), values
    lines.append(f"The stuck mass rings at {rad / (2.0 * math.pi):.6g} Hz until friction.sigma_1 damps it:")
    lines.append(f"{low:g} N s/m is a tenth of the critical damping, {high:g} half of it.")
    swings = any(scene.get(f"vibration.{name}", 0.0) != 0.0 for name in ("V_1", "a_d"))
    set_already = scene.get("friction.sigma_1", 0.0) != 0.0
    if swings or set_already or H * rad <= 2.0 * math.pi:
        why = "a step is shorter than a cycle" if not set_already else "friction.sigma_1 damps it"
        lines.append(f"Nothing else is needed: {'slip damps it in each period' if swings else why}.")
        return "\n".join(lines), values
    lines.append(f"In a step of {H:g} s F_t is one sample of it: set friction.sigma_1, or connect F_t_mean.")
    return "\n".join(lines), values | {"friction.sigma_1": low}


def coupling(
    fmu: FrictionFmu, scene: Mapping[str, Value], mass: float, step: float, master: str
) -> tuple[str, dict[str, Value]]:
    """The advice for a mass [kg] that a scene holds; UserError says what is wrong."""
    if master not in (*MASTERS, INSIDE):
        raise UserError(f"master = {master!r}: must be one of {', '.join(map(repr, (*MASTERS, INSIDE)))}")
    between("mass", real(mass, "mass"), "kg", MASSES)
    if scene.get("friction.model") == "Coulomb" and master != INSIDE:
        raise UserError("mass: friction.model = Coulomb never sticks, and sigma_1 does nothing in it")
    with fmu.session(scene) as session:
        sigma = stiffest(session)
    if sigma == 0.0:
        raise UserError("mass: sigma = 0 N/m: must be above 0 N/m; the contact is open")
    if master == INSIDE:
        return advice_inside(mass, sigma, step, scene)
    return advice(mass, sigma, master, step)


def stiffest(session: Session) -> float:
    """The largest stiffness [N/m] over a period of the vibration, at 64 of its moments."""
    found = session.get("sigma")
    if session.get("vibration.a_d") > 0.0:
        for _ in range(64):
            session.step(1.0 / (64.0 * session.get("vibration.f")))
            found = max(found, session.get("sigma"))
    return found


def between(name: str, value: float, unit: str, limits: tuple[float, float]) -> None:
    if not limits[0] <= value <= limits[1]:
        raise UserError(f"{name} {value:g} {unit}: must lie between {limits[0]:g} and {limits[1]:g} {unit}")
