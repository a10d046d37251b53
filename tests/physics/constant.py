"""Constant stiffness, held inputs and a vibrating velocity, in closed form.

Between reversals F relaxes toward s F_C over the path: F_1 = s F_C + (F_0 - s F_C) e^(-sigma L / F_C).
"""

from typing import Any

from workshop.reference.arithmetic import MP


def periodic_mean(sigma: Any, F_C: Any, V: Any, V_1: Any, f: Any) -> Any:
    """Time mean of F [N] over one period of the periodic state."""
    sigma, V, V_1, f, F_C = (MP.mpf(value) for value in (sigma, V, V_1, f, F_C))
    if abs(V) >= V_1:
        return F_C * MP.sign(V)
    omega = 2 * MP.pi * f
    angle = MP.acos(-V / V_1)  # V > 0 for |theta| < angle
    forward = 2 * (V * angle + V_1 * MP.sin(angle)) / omega
    q_plus, q_minus = (MP.exp(-sigma * L / F_C) for L in (forward, forward - V / f))
    # at the end of the forward and of the backward half of the cycle
    F_plus = F_C * ((1 - q_plus) - q_plus * (1 - q_minus)) / (1 - q_plus * q_minus)
    F_minus = -F_C + (F_plus + F_C) * q_minus

    def position(theta: Any) -> Any:
        return (V * theta + V_1 * MP.sin(theta)) / omega

    def mean_over(first: Any, last: Any, F_first: Any, sign: int) -> Any:
        def force(theta: Any) -> Any:
            path = abs(position(theta) - position(first))
            return sign * F_C + (F_first - sign * F_C) * MP.exp(-sigma * path / F_C)

        # the layer after a reversal has the width sqrt(F_C omega / (sigma V_1))
        scale = min(MP.sqrt(F_C * omega / (sigma * V_1)) / 4, (last - first) / 2)
        corners = [first]
        while scale < (last - first) / 2:
            corners.append(first + scale)
            scale *= 2
        return MP.quad(force, [*corners, last])

    total = mean_over(-angle, angle, F_minus, 1)
    total += mean_over(angle, 2 * MP.pi - angle, F_plus, -1)
    return total / (2 * MP.pi)
