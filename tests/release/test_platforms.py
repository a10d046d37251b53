"""The libraries of other platforms give the numbers that linux64's gives.

Windows' runs under Wine, that of ARM under qemu's user mode, if they are there.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import IDENTIFIED, PERIOD, PRINTED, TABLE_2, start_values
from tools.release.targets import build

WINE = next(filter(None, map(shutil.which, ("wine64", "wine", "/usr/lib/wine/wine64"))), None)
QEMU = next(filter(None, map(shutil.which, ("qemu-aarch64", "qemu-aarch64-static"))), None)
ARM_LIBRARIES = Path("/usr/aarch64-linux-gnu")
# Of the largest value of each output in the scenario: a tenth of the rounding that docs/numerics.md allows.
LIMIT = 1e-12
OUTPUTS = ("F_t", "F_t_mean", "F_y", "F_y_mean", "W_f", "Q_f", "sigma", "A_r", "delta", "delta_y")
LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")
PLANE = {"V_y": 0.2, "vibration.V_2": 0.7, "vibration.phase_2": 1.0, "friction.V_S": 0.5}
METHODS = ("collocation", "cvode", "backwardEuler", "trapezoid", "rk4", "explicitEuler")
SCENE = start_values(TABLE_2[1], IDENTIFIED)
FINE = [(PERIOD / 100, 100)]  # step [s], count


def scenarios() -> list[tuple[dict[str, Value], list[tuple[float, int]]]]:
    """Start values and steps; row 2 of Table 2, identified, first."""
    of_paper = [start_values(row, found) for found in (IDENTIFIED, PRINTED) for row in TABLE_2]
    of_paper[:2] = of_paper[1::-1]
    tolerances = ({**SCENE, "solver.tolerance": tolerance} for tolerance in (1e-2, 1e-9, 1e-12))
    return [
        *((values, [*FINE, (1e-4, 20), (1e6 * PERIOD, 2)]) for values in of_paper),
        *(({**SCENE, "solver.stepSize": 1e-8, "solver.method": name}, 2 * FINE) for name in METHODS),
        *((values, [(PERIOD / 7, 70)]) for values in tolerances),
        ({**SCENE, "friction.model": "Coulomb"}, [*FINE, (1e-3, 3)]),
        ({**SCENE, "contact.model": "Constant", "contact.sigma": 2.5e6}, FINE),
        *(
            (
                {**SCENE, **PLANE, "friction.model": law, "friction.limit": limit, **ratio},
                [*FINE, (1.3e-4, 10)],
            )
            for law in LAWS
            for limit in ("Constant", "Load")
            # A break-away multiplies rounding: no static friction of a bristle that sticks.
            for ratio in [{"friction.staticRatio": 1.3 if law == "LuGre" else 1.0}]
        ),
        ({"V": 0.01, "contact.stiffnessScale": 1e-6}, []),  # linear inputs
    ]


def words(fmu: FrictionFmu) -> str:
    """The input of run_scenarios."""
    lines = []
    for values, steps in scenarios():
        lines.append("scenario")
        for name, value in values.items():
            variable, number = fmu.variables[name], fmu.known.number(name, value, "scenario")
            lines.append(f"{'real' if variable.type == 'Real' else 'integer'} {variable.valueReference}")
            lines.append(float(number).hex())
        lines += ["start", *(f"step {h.hex()} {count}" for h, count in steps)]
    for k in range(50):
        for name, rate, half in (("V", -40.0, 10), ("d", 1e-3, 5)):
            sign = 1 if k % (2 * half) < half else -1
            lines.append(f"rate {fmu.variables[name].valueReference} {(sign * rate).hex()}")
        lines.append(f"step {(1e-4).hex()} 1")
    return "\n".join(lines)


def run(start: list[str], platform: str, library: Path, fmu: FrictionFmu) -> list[np.ndarray]:
    """OUTPUTS of every scenario, over the largest value of each, by a host program beside the library."""
    build(platform, ["run_scenarios"])
    host = library.parent / "tests" / "release" / f"run_scenarios{'.exe' if platform == 'win64' else ''}"
    numbers = [fmu.variables[name].valueReference for name in OUTPUTS]
    command = [*start, host, library, fmu.description.guid, *numbers]
    done = subprocess.run([*map(str, command)], input=words(fmu), capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    rows = [line.split() for line in done.stdout.splitlines()]
    table = np.array([[int(row[0]), *map(float.fromhex, row[1:])] for row in rows])
    runs = [table[table[:, 0] == k + 1, 1:] for k in range(len(scenarios()))]
    assert all(len(one) and np.isfinite(one).all() for one in runs)
    return [one / np.maximum(np.abs(one).max(axis=0), 1e-300) for one in runs]


@pytest.fixture(scope="module")
def linux_runs(library: Callable[[str], Path], fmu: FrictionFmu) -> list[np.ndarray]:
    return run([], "linux64", library("linux64"), fmu)


def assert_same(runs: list[np.ndarray], others: list[np.ndarray]) -> None:
    for k, (one, other) in enumerate(zip(runs, others, strict=True)):
        assert np.abs(one - other).max() <= LIMIT, scenarios()[k]


@pytest.mark.skipif(not (QEMU and ARM_LIBRARIES.is_dir()), reason="qemu-user or libc6-arm64-cross is missing")
def test_linux_on_arm(library: Callable[[str], Path], linux_runs: list[np.ndarray], fmu: FrictionFmu) -> None:
    start = [str(QEMU), "-L", str(ARM_LIBRARIES)]
    assert_same(run(start, "aarch64-linux", library("aarch64-linux"), fmu), linux_runs)


@pytest.mark.skipif(not WINE, reason="Wine is missing (Debian: wine64)")
@pytest.mark.slow
def test_windows(
    library: Callable[[str], Path],
    linux_runs: list[np.ndarray],
    fmu: FrictionFmu,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(os.environ, "WINEPREFIX", str(tmp_path / "wine"))
    monkeypatch.setitem(os.environ, "WINEDEBUG", "-all")
    assert_same(run([str(WINE)], "win64", library("win64"), fmu), linux_runs)
