"""For `solution` to agree with: the differential equation itself, by Gauss collocation at 40 digits.

    D_i = delta_a + h sum_j A_ij (a(t_j) D_j + V(t_j)),     a = -sigma |V| / g

A polynomial of degree 16 satisfies the equation at 16 Gauss points of each piece. The mesh is finer than
that of the quadrature, and nothing else but the scene is shared.
"""

from __future__ import annotations

from typing import Any

from workshop.reference.arithmetic import MP, MULTIPRECISION, gauss_rule
from workshop.reference.mesh import graded_mesh
from workshop.reference.scene import Drive, Scene

STAGES = 16


def trajectory(scene: Scene, t0: Any, h: Any, delta_0: Any, ratio: float = 1.5) -> tuple[Any, Any, Any, Any]:
    """Deflection [m] at t0 + h, impulse [N s], work and heat [J] over the interval."""
    rule = gauss_rule(STAGES)
    drive = Drive(scene, t0, MULTIPRECISION)
    mesh = graded_mesh(scene, t0, h, ratio)
    delta, impulse, work, heat = MP.mpf(delta_0), MP.mpf(0), MP.mpf(0), MP.mpf(0)
    for begin, end in zip(mesh[:-1], mesh[1:], strict=True):
        size = end - begin
        times = [begin + size * x for x in rule.nodes]
        V = [drive.V(t) for t in times]
        sigma = [drive.sigma(t) for t in times]
        rate = [-drive.relaxation_rate(times[j]) for j in range(STAGES)]
        system = MP.matrix(STAGES, STAGES)
        right = MP.matrix(STAGES, 1)
        for i in range(STAGES):
            row = rule.from_start[i]
            for j in range(STAGES):
                system[i, j] = (1 if i == j else 0) - size * row[j] * rate[j]
            right[i] = delta + size * MP.fdot(row, V)
        D = MP.lu_solve(system, right)
        change = [rate[j] * D[j] + V[j] for j in range(STAGES)]
        force = [sigma[j] * D[j] + drive.sigma_1 * change[j] + drive.sigma_2 * V[j] for j in range(STAGES)]
        impulse += size * MP.fdot(rule.weights, force)
        work += size * sum(w * F * v for w, F, v in zip(rule.weights, force, V, strict=True))
        heat += size * sum(
            w * (F * v - k * D_j * rate_j)
            for w, F, v, k, D_j, rate_j in zip(rule.weights, force, V, sigma, D, change, strict=True)
        )
        delta += size * MP.fdot(rule.weights, change)
    return delta, impulse, work, heat
