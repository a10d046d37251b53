"""The listing of panels: those of a step adjoin, fill it, and cost what the FMU counts."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu
from tools.build import build_targets

STEP = 3e-5  # s, less than two periods: one interval
SCENES = {  # in the hunt's words, and as start values of the FMU
    "relaxes": ("law=LuGre staticRatio=1.3", {"friction.model": "LuGre", "friction.staticRatio": 1.3}),
    "coulomb": ("law=Coulomb V_2=0.3", {"friction.model": "Coulomb", "vibration.V_2": 0.3}),
    "slips": ("law=ElasticPlastic V_2=0.3", {"friction.model": "ElasticPlastic", "vibration.V_2": 0.3}),
}

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the linker's --wrap")


@pytest.mark.parametrize("kind", SCENES)
def test_panels_fill_the_step(fmu: FrictionFmu, kind: str) -> None:
    words, values = SCENES[kind]
    sequence = f"tolerance=1e-6 V=0.5 V_1=1.44 a_d=1.1e-6 stiffnessScale=1e-6 h={STEP!r} {words}"
    program = build_targets("default", ["panels"]) / "hunt" / "panels"
    lines = subprocess.run(
        [program, sequence], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    rows = [line.split() for line in lines if line[0].isdigit()]
    start, end = np.array([row[:2] for row in rows], float).T
    assert start[0] == 0.0 and end[-1] == pytest.approx(STEP, rel=1e-9)
    assert (start[1:] == end[:-1]).all() and (start < end).all()
    assert kind in {row[-1] for row in rows}
    made = sum(9 * float(row[-2]) for row in rows)
    scene = {"V": 0.5, "vibration.V_1": 1.44, "vibration.a_d": 1.1e-6, "contact.stiffnessScale": 1e-6}
    with fmu.session(scene | values | {"solver.tolerance": 1e-6}) as session:
        session.step(STEP)
        assert made == pytest.approx(session.get("solver.evaluations"), abs=9.0)
