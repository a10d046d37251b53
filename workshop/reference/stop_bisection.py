"""For `stop` to agree with in ElasticPlastic: no event is sought, cells shrink at the clamp.

On nodes t_k the stop operator is delta_k = clamp(delta_(k-1) + X_k - X_(k-1), -D_k, D_k). A cell whose nodes
all stick, or all slip on one side, is integrated as it stands; another is cut into smaller cells, down to
1e-9 of a period and less. Derivatives are those of the polynomial through a cell's nodes.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from workshop.reference.arithmetic import EXTENDED, MP, gauss_rule
from workshop.reference.scene import Drive, Scene

NODES = 12
CELLS = 1000  # of a period, or of a shorter step
CUTS = 8
DEPTH = 12


@cache
def _derivative_matrix() -> np.ndarray:
    """Derivatives at the Gauss nodes on [0, 1] of the polynomial through the values there."""
    x = gauss_rule(NODES).nodes
    weights = [1 / MP.fprod(x[j] - x[k] for k in range(NODES) if k != j) for j in range(NODES)]
    rows = [
        [0 if i == j else weights[j] / weights[i] / (x[i] - x[j]) for j in range(NODES)] for i in range(NODES)
    ]
    for i in range(NODES):
        rows[i][i] = -MP.fsum(rows[i])
    return EXTENDED.matrix(rows)


class _March:
    """The state and the integrals up to the time reached."""

    def __init__(self, scene: Scene, t0: Any, delta_0: Any) -> None:
        self.drive = Drive(scene, t0, EXTENDED)
        rule = gauss_rule(NODES)
        self.nodes, self.weights = EXTENDED.array(rule.nodes), EXTENDED.array(rule.weights)
        zero, delta_0 = EXTENDED.real(0), EXTENDED.real(delta_0)
        sigma = self.drive.sigma(zero)
        bound = self.drive.bound(zero)
        self.delta = min(max(delta_0, -bound), bound)
        self.kind = int(np.sign(delta_0)) if abs(delta_0) >= bound else 0
        self.impulse, self.work = zero, zero
        self.heat = sigma * (delta_0**2 - self.delta**2) / 2

    def cells(self, edges: np.ndarray, depth: int) -> None:
        """March over neighbouring cells; all times of all cells are evaluated at once."""
        begin, size = edges[:-1, None], np.diff(edges)[:, None]
        times = np.concatenate([begin + size * self.nodes, edges[1:, None]], axis=1)
        before = np.concatenate([begin, times[:, :-1]], axis=1)
        moves, D = self.drive.travel(before, times), self.drive.bound(times)
        for k in range(len(times)):
            deltas, kinds = self._clamp(moves[k], D[k])
            if depth == 0 or (kinds == self.kind).all():
                self._integrate(times[k], size[k, 0], int(kinds[0]), D[k], deltas)
                self.delta, self.kind = deltas[-1], int(kinds[-1])
            else:
                self.cells(
                    begin[k, 0] + size[k, 0] * np.arange(CUTS + 1, dtype=np.longdouble) / CUTS, depth - 1
                )

    def _clamp(self, moves: np.ndarray, D: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        delta, deltas, kinds = self.delta, np.empty_like(moves), np.empty(len(moves), dtype=int)
        for i in range(len(moves)):
            delta = delta + moves[i]
            kinds[i] = 1 if delta > D[i] else -1 if delta < -D[i] else 0
            delta = deltas[i] = min(max(delta, -D[i]), D[i])
        return deltas, kinds

    def _integrate(self, times: Any, size: Any, slip: int, D: Any, delta: Any) -> None:
        drive, times, D, delta = self.drive, times[:-1], D[:-1], delta[:-1]
        V, sigma = drive.V(times), drive.sigma(times)
        rate = slip * (_derivative_matrix() @ D) / size if slip else V
        force = sigma * delta + drive.sigma_1 * rate + drive.sigma_2 * V
        time = size * self.weights
        self.impulse += (time * force).sum()
        self.work += (time * force * V).sum()
        self.heat += (time * (force * V - sigma * delta * rate)).sum()


def advance(scene: Scene, t0: Any, h: Any, delta_0: Any) -> tuple[Any, Any, Any, Any]:
    """Deflection [m], impulse [N s], work and heat [J] from t0 [s] over h [s]."""
    h = EXTENDED.real(h)
    march = _March(scene, t0, delta_0)
    periods = max(1, int(np.ceil(float(h) * scene.f)))
    edges = h * np.arange(CELLS * periods + 1, dtype=np.longdouble) / (CELLS * periods)
    march.cells(edges, DEPTH)
    return march.delta, march.impulse, march.work, march.heat
