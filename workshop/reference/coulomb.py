"""Coulomb friction between reversals: F_t = F_C(t) sgn V + sigma_2 V."""

from dataclasses import replace
from typing import Any

from workshop.reference.arithmetic import EXTENDED, MP, MULTIPRECISION, gauss_rule
from workshop.reference.mesh import load_halvings, longest_piece
from workshop.reference.scene import Drive, Scene, events


def coulomb(scene: Scene, t0: Any, h: Any, delta_0: Any) -> tuple[Any, Any, Any, Any]:
    """Deflection (as it was) [m], impulse [N s], work and heat [J]: all its work is heat."""
    h = MP.mpf(h)
    drive = Drive(scene, t0, MULTIPRECISION)
    corners = [MP.mpf(0), *sorted([*events(drive, h), *load_halvings(drive, h)]), h]
    begin, size, sign = [], [], []
    for left, right in zip(corners[:-1], corners[1:], strict=True):
        count = max(1, int(MP.ceil((right - left) / longest_piece(scene, drive, left, right))))
        begin += [left + (right - left) * k / count for k in range(count)]
        size += [(right - left) / count] * count
        sign += [MP.sign(drive.V((left + right) / 2))] * count
    begin, size, sign = (EXTENDED.array(values)[:, None] for values in (begin, size, sign))
    rule = gauss_rule(EXTENDED.nodes)
    tau = begin + size * EXTENDED.array(rule.nodes)[None, :]
    drive = Drive(scene, t0, EXTENDED)
    V = drive.V(tau)
    force = sign * drive.coulomb(tau) + drive.sigma_2 * V
    time = size * EXTENDED.array(rule.weights)
    work = (time * force * V).sum()
    return EXTENDED.real(delta_0), (time * force).sum(), work, work


def path(scene: Scene, t0: Any, h: Any) -> Any:
    """Integral of |V| [m]: the work against one newton."""
    return coulomb(replace(without_contact(scene, 1.0), sigma_2=0.0), t0, h, 0)[2]


def without_contact(scene: Scene, limit: float) -> Scene:
    """The same motion against a constant limit [N], whatever the load does."""
    contact = replace(scene.contact, model="Constant")
    return replace(
        scene, friction="Coulomb", limit="Constant", F_C=limit, input="Separation", contact=contact
    )


def mean_limit(scene: Scene, t0: Any, h: Any) -> Any:
    """Time mean of F_C(t) [N]: of the constant, or of mu F_n(t)."""
    forward = replace(scene, friction="Coulomb", V=1.0, V_rate=0.0, V_1=0.0, sigma_2=0.0)
    return coulomb(forward, t0, h, 0)[1] / EXTENDED.real(MP.mpf(h))
