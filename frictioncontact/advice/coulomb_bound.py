"""How far Coulomb friction can be from a Dahl bristle of constant stiffness: a bound.

Between reversals F relaxes over the path x, F - F_C s = (F_0 - F_C s) e^(-x / D), D = F_C / sigma and
s = sgn V (Eq. 2), so with |F_0| <= F_C Coulomb's force is wrong by at most 2 F_C e^(-x / D). The error of the
mean over a step of H is at most 2 F_C / H times the integral A of e^(-x / D) after each reversal that counts
in it: the 2 ceil(H f) in it at most, and the one before.

A, with V_0 = |V|, V_1 > V_0, omega = 2 pi f, x(t) from the reversal:

    against V   |V| is concave, its peak p = V_1 - V_0 in the middle of T_s = (2 / omega) acos(V_0 / V_1), so
                x >= p t^2 / T_s in the first half and p T_s / 4 in the second
    along V     |V| >= (a / omega) sin(omega t) with a = omega sqrt(V_1^2 - V_0^2) and sin u >= 2 u / pi up to
                pi / 2, so x >= a t^2 / pi in the first quarter period and a pi / (4 omega^2) later

and the integral of e^(-k t^2) is at most sqrt(pi / k) / 2.
"""

import math
from collections.abc import Mapping

from frictioncontact.fmu import Value


def coulomb_errors(values: Mapping[str, Value], sigma: float, step: float) -> tuple[float, float]:
    """Bounds, over F_C, of Coulomb's errors of F_t and of F_t_mean over steps of `step` [s]; inputs held.

    values: of every variable of the scene; sigma: its stiffness [N/m]. inf where nothing is proven: where d
    vibrates, the contact is open, the law is another, V stands still, or the contact moves across it.
    """
    if values["friction.model"] != "Dahl" or values["friction.limit"] != "Constant" or sigma == 0.0:
        return math.inf, math.inf
    V, V_1, f = (float(values[name]) for name in ("V", "vibration.V_1", "vibration.f"))
    if any(values[name] != 0.0 for name in ("vibration.a_d", "friction.sigma_1", "V_y", "vibration.V_2")):
        return math.inf, math.inf
    D = float(values["F_C"]) / sigma
    slowest = abs(V) - abs(V_1)
    if slowest > 0.0:  # one transient, at the start
        return 2.0 * math.exp(-slowest * step / D), 2.0 * D / (slowest * step)
    if slowest == 0.0:
        return math.inf, math.inf
    omega = 2.0 * math.pi * f
    against = 2.0 / omega * math.acos(abs(V) / abs(V_1))
    peak, a = -slowest, omega * math.sqrt(V_1**2 - V**2)
    A = max(
        0.5 * math.sqrt(math.pi * D * against / peak) + 0.5 * against * math.exp(-peak * against / (4 * D)),
        0.5 * math.pi * math.sqrt(D / a) + math.exp(-a * math.pi / (4 * omega**2 * D)) / f,
    )
    return 2.0, 2.0 * (2 * math.ceil(step * f) + 1) * A / step  # F_t: just after a reversal
