"""A host with its own SUNDIALS, of another version and with all its symbols global, beside the FMU's."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("sksundae", reason="scikit-sundae is missing: it brings the other SUNDIALS")

HOST = """
import ctypes, sys
sys.setdlopenflags(sys.getdlopenflags() | ctypes.RTLD_GLOBAL)  # the host's SUNDIALS comes first for everyone
from pathlib import Path
import numpy as np
from sksundae.cvode import CVODE
from sksundae import SUNDIALS_VERSION
from fmi_library import OK, Instance, Library

host = ctypes.CDLL(None)
assert host.CVodeCreate and host.SUNContext_Create  # global, to be found before any other
assert SUNDIALS_VERSION.split(".")[0] != "6", SUNDIALS_VERSION

def decay(t, y, slope):
    slope[0] = -3.0 * y[0]

def host_is_right():
    solved = CVODE(decay, rtol=1e-10, atol=1e-12).solve(np.array([0.0, 1.0]), np.array([1.0]))
    assert abs(solved.y[-1, 0] - np.exp(-3.0)) < 1e-8

library = Library(Path(sys.argv[1]))
with Instance(library) as instance, Instance(library) as reference:
    for each in (instance, reference):
        scene = {"contact.stiffnessScale": 1e-3, "vibration.V_1": 0.4, "solver.tolerance": 1e-9}
        assert each.set(scene) == OK
    assert instance.choose({"solver.method": 2}) == OK
    reference.initialize()
    instance.bring_to("initialization")
    if instance.call("fmi2ExitInitializationMode") != OK:
        print("without cvode:", instance.last_message.text)
        raise SystemExit(77)
    for step in range(20):
        for each in (instance, reference):
            assert each.step(step * 1.3e-5, 1.3e-5) == OK, each.messages
        host_is_right()
        difference = np.subtract(instance.get("F_t", "F_t_mean"), reference.get("F_t", "F_t_mean"))
        assert np.abs(difference).max() < 1e-6 * 55, difference
    print("right", instance.get("solver.evaluations")[0] > 100)
"""


def test_two_sundials_in_one_process(unzipped_fmu: Path) -> None:
    command = [sys.executable, "-c", HOST, str(unzipped_fmu)]
    folder = Path(__file__).parent  # where fmi_library is
    host = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if host.returncode == 77:
        pytest.skip(host.stdout)
    assert host.returncode == 0, host.stderr
    assert host.stdout == "right True\n"
