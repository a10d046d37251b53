"""The oldest versions that pyproject.toml allows: each is installed, and the package runs with them."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tools.project import ROOT

PROGRAM = """
import sys
import frictioncontact as fc
fmu = sys.argv[1]
rows = {"V [mm/s]": [100, 200, 300], "F_t_mean [kN]": [0.050, 0.051, 0.0505]}
found = fc.identify(rows, "F_C", fmu=fmu)
found.plot()
print(f"{found.values['F_C']:.4f}")
print(fc.simulate({"V": 0.5}, stop=1e-3, step=1e-4, fmu=fmu)["F_t"].iloc[-1])
with fc.ModelExchange({"V": 0.01}, fmu=fmu) as contact:
    contact.advance(1e-3)
    print(f"{contact.get('F_t'):.3f}")
"""


def of_an_index(*command: str) -> None:
    """Runs pip, or skips where no index of packages can be reached."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if "Could not find a version" in done.stderr and "NewConnectionError" in done.stderr:
        pytest.skip("no index of packages can be reached")
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_the_package_runs_with_the_oldest_versions(fmu_path: Path, tmp_path: Path) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    bounds = [*project["dependencies"], *project["optional-dependencies"]["plot"]]
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "oldest")], check=True)
    python = tmp_path / "oldest" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    of_an_index(str(python), "-m", "pip", "install", "-q", *(bound.replace(">=", "==") for bound in bounds))
    done = subprocess.run(
        [str(python), "-c", PROGRAM, str(fmu_path)],
        env=os.environ | {"PYTHONPATH": str(ROOT)}, cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.stdout, done.returncode) == ("50.5000\n55.0\n55.000\n", 0), done.stderr
