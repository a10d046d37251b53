"""Steps that begin at or near a place where |V| dips to nearly nothing or to nothing at all.

    V = -(1 + depth) V_1,  V_1 cos(2 pi f t)

|V| is least at whole periods, where it is depth V_1; where depth < 0 V reverses twice around it. At the
dip the force hardly relaxes, an instant later it does within 1e-4 of a period: the step has to notice.
"""

from __future__ import annotations

import pytest

from frictioncontact.fmu import FrictionFmu
from workshop.reference import solution as reference
from workshop.reference.arithmetic import MP, multiprecision
from workshop.reference.contact import Contact, stiffness
from workshop.reference.scene import Scene
from workshop.reference.start_values import start_values_of

FREQUENCY = 16384.0  # Hz, so that the dips are at exact times
DEPTHS = [0.0, 1e-14, -1e-14, 1e-8, -1e-8, 1e-2, -1e-2]
OFFSETS = [0.0, 1e-9, -1e-9, 1e-5, -1e-5, 1e-2, -1e-2]  # of a period
V_1, F_C = 0.25, 2.5


@pytest.mark.parametrize("kappa", [1e2, 1e7])
@pytest.mark.parametrize("depth", DEPTHS)
def test_error_is_at_most_the_tolerance(fmu: FrictionFmu, kappa: float, depth: float) -> None:
    sigma = kappa * 2 * 3.14159 * FREQUENCY * F_C / V_1
    contact = Contact(stiffnessScale=sigma / float(stiffness(Contact(), 14e-6, 5.5e10)))
    scene = Scene(
        V=-(1 + depth) * V_1, V_1=V_1, F_C=F_C, E=5.5e10, f=FREQUENCY, a_d=5e-7, phase_d=1.0, contact=contact
    )
    missed = []
    for offset in OFFSETS:
        start = (1.0 + offset) / FREQUENCY
        h = 0.7 / FREQUENCY
        delta_0 = 0.5 * F_C / float(reference.sigma(scene, start))
        delta, impulse, _ = reference.solve(scene, start, MP.mpf(start) + MP.mpf(h), delta_0)
        F_t = float(reference.force(scene, MP.mpf(start) + MP.mpf(h), delta))
        F_t_mean = float(multiprecision(impulse) / MP.mpf(h))
        for tolerance in (1e-3, 1e-6, 1e-10):
            values = start_values_of(scene) | {"delta_0": delta_0, "solver.tolerance": tolerance}
            with fmu.session(values, start) as session:
                session.step(h)
                of_force = abs(session.get("F_t") - F_t) / F_C
                of_mean = abs(session.get("F_t_mean") - F_t_mean) / F_C
            if not max(of_force, of_mean) <= tolerance:
                missed.append(f"offset {offset:g}, {tolerance:g}: F_t {of_force:.1e}, F_t_mean {of_mean:.1e}")
    assert not missed, "errors over F_C:\n" + "\n".join(missed)
