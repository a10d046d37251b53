"""The scenarios that every platform's library runs, and how its host program is made and started."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
from fmpy.model_description import ModelDescription

from frictioncontact.parameters import IDENTIFIED, PERIOD, PRINTED, TABLE_2, start_values
from workshop.release.targets import build

OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")
METHODS = ("collocation", "cvode", "backwardEuler", "trapezoid", "rk4", "explicitEuler")


def build_host(platform: str, library: Path) -> Path:
    """run_scenarios for a platform, beside the library of that platform in CMake's folder."""
    build(platform, ["run_scenarios"])
    suffix = ".exe" if platform == "win64" else ""
    return library.parent / "tests" / "release" / f"run_scenarios{suffix}"


def commands(description: ModelDescription) -> str:
    """The input of run_scenarios."""
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    first, last = reference[OUTPUTS[0]], reference[OUTPUTS[-1]]
    assert last - first + 1 == len(OUTPUTS)
    lines: list[str] = []

    def begin(name: str, reals: dict[str, float], **integers: int) -> None:
        lines.append(f"scenario {name}")
        lines.extend(f"integer {reference[key.replace('_', '.')]} {value}" for key, value in integers.items())
        lines.extend(f"real {reference[key]} {float(value).hex()}" for key, value in reals.items())
        lines.append("start")

    def step(h: float, count: int) -> None:
        lines.append(f"step {h.hex()} {count} {first} {last}")

    for parameters in (PRINTED, IDENTIFIED):
        for row in TABLE_2:
            begin(f"table2-row{row.number}-{parameters.name}", start_values(row, parameters))
            step(PERIOD / 100, 100)
            step(1e-4, 20)
            step(1e6 * PERIOD, 2)
    identified = start_values(TABLE_2[1], IDENTIFIED)
    for k, method in enumerate(METHODS):
        begin(f"method-{method}", {**identified, "solver.stepSize": 1e-8}, solver_method=k + 1)
        step(PERIOD / 100, 200)
    for tolerance in (1e-2, 1e-9, 1e-12):
        begin(f"tolerance-{tolerance:g}", {**identified, "solver.tolerance": tolerance})
        step(PERIOD / 7, 70)
    begin("coulomb", identified, friction_model=2)
    step(PERIOD / 100, 100)
    step(1e-3, 3)
    begin("constant", {**identified, "contact.sigma": 2.5e6}, contact_model=2)
    step(PERIOD / 100, 100)
    begin("linear-inputs", {"V": 0.01, "contact.stiffnessScale": 1e-6})
    for k in range(50):
        lines.append(f"rate {reference['V']} {(-40.0 if k % 20 < 10 else 40.0).hex()}")
        lines.append(f"rate {reference['d']} {(1e-3 if k % 10 < 5 else -1e-3).hex()}")
        step(1e-4, 1)
    return "\n".join(lines) + "\n"


def run(start: list[str], library: Path, description: ModelDescription) -> dict[str, np.ndarray]:
    """Runs all scenarios with a host program; one array a scenario, columns time and OUTPUTS."""
    text = commands(description)
    done = subprocess.run(
        [*start, str(library), description.guid], input=text, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr[-2000:]
    rows: dict[str, list[list[float]]] = {}
    for line in done.stdout.splitlines():
        name, *numbers = line.split()
        rows.setdefault(name, []).append([float.fromhex(number) for number in numbers])
    assert len(rows) == text.count("scenario ")
    return {name: np.array(table) for name, table in rows.items()}


def largest_difference(runs: dict[str, np.ndarray], others: dict[str, np.ndarray]) -> dict[str, float]:
    """For each scenario the largest difference of an output, over the largest value of that output in it."""
    assert runs.keys() == others.keys()
    differences = {}
    for name, table in runs.items():
        assert table.shape == others[name].shape and np.isfinite(table).all()
        scale = np.abs(table).max(axis=0)
        scale[scale == 0.0] = 1.0
        differences[name] = float((np.abs(table - others[name]) / scale).max())
    return differences
