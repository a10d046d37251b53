"""The step at which a mass on a stuck contact turns unstable in libcosim and fmpy, against eigenvalues."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from frictioncontact.fmu import FrictionFmu
from tools.bench.coupling import Belt, transition
from tools.project import ROOT

systems = pytest.importorskip("examples.systems", reason="libcosimpy is not installed")
DESCRIPTION = (ROOT / "examples" / "stick-slip" / "SystemStructure.ssd").read_text(encoding="utf-8")
SPEED = 1e-6  # m/s, from which the swing starts: the bristle does not creep at it
COUNT = 600  # steps
AT_REST = Belt(m=1.0, k=1e5, c=0.0, V_0=0.0, V_a=0.0, F_C=1e9)
SYSTEMS = {  # damping outside, and sigma_1 [N s/m]
    "outside: c = 300 N s/m": (replace(AT_REST, c=300.0), 0.0),
    "`friction.sigma_1` = 300 N s/m": (AT_REST, 300.0),
    "`friction.sigma_1` = 2500 N s/m": (AT_REST, 2500.0),
}
IMPORTERS: dict[str, Callable[[Path, int, list[tuple[str, str]]], dict[tuple[str, str], np.ndarray]]] = {
    "libcosim": lambda ssp, step_ns, signals: systems.run_libcosim(ssp, step_ns, COUNT, signals),
    "FMPy": lambda ssp, step_ns, signals: systems.run_fmpy(ssp, 1e-9 * step_ns, COUNT, signals),
}


def radius(belt: Belt, sigma_1: float, H: float) -> float:
    """Of (x, v, delta, velocity of the contact's last step): both start from what the last step left."""
    x, v, delta, last = np.eye(4)
    force = belt.sigma * delta + sigma_1 * last
    mass = transition(belt, H)[:, :3] @ np.array([x, v, force])
    values = np.linalg.eigvals(np.array([*mass, delta - H * v, -v]))
    return float(np.abs(np.delete(values, np.abs(values - 1.0).argmin())).max())  # 1: F = k x at rest


@pytest.mark.parametrize("importer", IMPORTERS)
@pytest.mark.parametrize("system", SYSTEMS)
def test_edge_is_that_of_the_eigenvalues(
    fmu: FrictionFmu, fmu_path: Path, mass_on_belt: Path, tmp_path: Path, system: str, importer: str
) -> None:
    belt, sigma_1 = SYSTEMS[system]
    with fmu.session({"contact.stiffnessScale": 1e-7}) as session:
        scale = 1e-7 * belt.sigma / session.get("sigma")
    values = {
        ("mass", "m"): belt.m, ("mass", "k"): belt.k, ("mass", "c"): belt.c, ("mass", "v_0"): SPEED,
        ("mass", "belt.V_0"): 0.0, ("mass", "belt.V_1"): 0.0, ("contact", "V"): -SPEED,
        ("contact", "F_C"): belt.F_C, ("contact", "contact.stiffnessScale"): scale,
        ("contact", "friction.sigma_1"): sigma_1,
    }  # fmt: skip
    ssp = systems.write_ssp(
        systems.with_parameters(DESCRIPTION, values), [fmu_path, mass_on_belt], tmp_path / "stuck.ssp"
    )

    def grows(H: float) -> bool:
        speed = np.abs(IMPORTERS[importer](ssp, round(1e9 * H), [("mass", "v")])["mass", "v"])
        return bool(not speed[500:].max() <= speed[300:400].max())

    theory = brentq(lambda H: radius(belt, sigma_1, H) - 1.0, 1e-5, 5e-4)
    if belt.c:  # docs/machine.md: H < c / sigma, which the mass's own spring and the damping hardly move
        assert theory == pytest.approx(belt.c / belt.sigma, rel=0.02)
    assert grows(1.02 * theory) and not grows(0.98 * theory)
