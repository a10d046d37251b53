"""The FMU in other hands: nothing for checkers; a scene in each importer; FMPy, libcosim and Ecos agree."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import casadi
import fmpy
import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

from frictioncontact.batch import simulate_many
from frictioncontact.fmu import OUTPUTS, SETTLED, FrictionFmu, simulate
from frictioncontact.parameters import IDENTIFIED, TABLE_2, start_values
from tools.description import read
from tools.project import ROOT


def test_the_page_names_the_versions_that_are_tested() -> None:
    page = (ROOT / "docs" / "compatibility.md").read_text(encoding="utf-8")
    packages = {
        "CasADi": "casadi", "Ecos": "ecospy", "FMPy": "fmpy", "PathSim-FMI": "pathsim-fmi",
        "fmuloader": "fmuloader", "fmureader": "fmureader", "fmutool": "fmu_manipulation_toolbox",
        "libcosimpy": "libcosimpy",
    }  # fmt: skip
    for name, package in packages.items():
        assert f"{name} {version(package)}" in page


def test_fmpy_validate_finds_nothing(fmu_path: Path) -> None:
    assert validate_fmu(str(fmu_path)) == []


def fmutool(*arguments: str | Path, **variables: str) -> str:
    """Its messages; a failure is the test's."""
    command = [Path(sys.executable).with_name("fmutool"), *arguments]
    environment = os.environ | variables
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_fmutool_finds_nothing(fmu_path: Path) -> None:
    said = fmutool("-input", fmu_path, "-check")
    assert "compliant with FMI-2.0" in said and "No semantic error" in said
    assert not re.search("error|warning", said.replace("No semantic error", ""), re.IGNORECASE)


# The scene of every importer: ten steps of half a millisecond from 0, ten periods of the vibration each.
SCENE = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.417e-7}
STEP, STEPS = 5e-4, 10


# N, F_t_mean at its end, of an independent reference in more digits: the bristle has settled long before.
MEAN = pytest.approx(26.442473955554, abs=1e-11)


def test_the_scene_in_fmpy(fmu_path: Path) -> None:
    times = {"output_interval": STEP, "stop_time": STEPS * STEP, "fmi_type": "CoSimulation"}
    result = simulate_fmu(str(fmu_path), start_values=SCENE, output=["F_t_mean"], **times)
    assert result["F_t_mean"][-1] == MEAN


def test_the_scene_in_fmuloader(fmu_path: Path) -> None:
    """With the model description that fmureader gives it."""
    reader = pytest.importorskip("fmureader.fmi2", reason="fmureader is not installed")
    loader = pytest.importorskip("fmuloader.fmi2", reason="fmuloader is not installed")
    model = reader.read_model_description(fmu_path)
    references = {variable.name: variable.value_reference for variable in model.model_variables}
    slave = loader.Fmi2Slave(fmu_path, model_identifier=model.co_simulation.model_identifier)
    slave.instantiate("contact", loader.Fmi2Type.CO_SIMULATION, guid=model.guid)
    slave.setup_experiment(start_time=0.0)
    slave.enter_initialization_mode()
    slave.set_real([references[name] for name in SCENE], list(SCENE.values()))
    slave.exit_initialization_mode()
    for k in range(STEPS):
        slave.do_step(STEP * k, STEP)
    (end,) = slave.get_real([references["F_t_mean"]])
    slave.terminate()
    slave.free_instance()
    assert end == MEAN


def test_the_scene_in_pathsim(fmu_path: Path) -> None:
    """Every input is connected, since PathSim sets others to 0. It steps at the start of each interval."""
    blocks = pytest.importorskip("pathsim.blocks", reason="pathsim-fmi is not installed")
    from pathsim import Connection, Simulation
    from pathsim_fmi import CoSimulationFMU

    contact = CoSimulationFMU(str(fmu_path), start_values=SCENE, dt=STEP)
    inputs = {v.name: float(v.start) for v in read().modelVariables if v.causality == "input"} | {"V": 0.5}
    sources = {name: blocks.Constant(value) for name, value in inputs.items()}
    wires = [Connection(source, contact[name]) for name, source in sources.items()]
    Simulation([contact, *sources.values()], wires, dt=STEP, log=False).run((STEPS - 0.5) * STEP)
    assert contact.outputs["F_t_mean"] == MEAN


@pytest.mark.slow
def test_the_scene_after_fmutool_has_compiled_it(without_binaries: Path, tmp_path: Path) -> None:
    compiled = tmp_path / "compiled.fmu"
    compiler = tmp_path / "cc"
    compiler.write_text('#!/bin/sh\nexec cc "$@" -O0 -g0\n')  # a third of the time
    compiler.chmod(0o755)
    fmutool("-input", without_binaries, "-compile-sources", "-output", compiled, CC=str(compiler))
    with FrictionFmu(compiled) as fmu:
        run = simulate(fmu, SCENE, STEP, STEPS, outputs=["F_t_mean"])
    assert run["F_t_mean"][-1] == MEAN


@pytest.mark.skipif(shutil.which("fmi-sim") is None, reason="fmi-sim is not installed")
def test_the_scene_in_fmi_sim(fmu_path: Path, tmp_path: Path) -> None:
    result = tmp_path / "result.csv"
    options = ["-s", "0", "-f", str(STEPS * STEP), "--step", str(STEP), "--output-interval", str(STEP)]
    values = [part for name, value in SCENE.items() for part in ("--init-values", f"{name}={value}")]
    told = subprocess.run(["fmi-sim", "--version"], capture_output=True, text=True)
    (name,) = re.findall(r"fmi-sim [\d.]+", told.stdout + told.stderr)
    assert name in (ROOT / "docs" / "compatibility.md").read_text(encoding="utf-8")
    command = ["fmi-sim", "--model", fmu_path, "-o", result, "co-simulation", *options, *values]
    subprocess.run(command, check=True, capture_output=True, timeout=60)
    rows = np.genfromtxt(result, delimiter=",", names=True)
    assert len(rows) == STEPS + 1 and rows["time"][-1] == pytest.approx(STEPS * STEP)
    assert rows["F_t_mean"][-1] == MEAN


def test_the_scene_in_casadi(fmu: FrictionFmu) -> None:
    """Model exchange has no mean of a step. Its F_t_settled is the limit of F_t_mean."""
    dae = casadi.DaeBuilder("contact", str(fmu.directory))
    for name, value in SCENE.items():
        dae.set(name, value)
    outputs = dae.create("outputs", ["u"], ["y"])
    inputs = [SCENE.get(name, fmu.variables[name].start) for name in dae.u()]
    settled = outputs([float(value) for value in inputs])[dae.y().index("F_t_settled")]
    assert float(settled) == MEAN


def test_fmpy_sends_no_input_derivatives(fmu_path: Path) -> None:
    """As docs/tools.md says: FMPy's array of derivatives has nine places, whatever the inputs are."""
    drive = np.array([(0.0, 0.1), (1e-3, 0.2)], dtype=[("time", float), ("V", float)])
    with pytest.raises(ValueError, match="sequence of same size"):
        simulate_fmu(str(fmu_path), input=drive, set_input_derivatives=True, stop_time=1e-3)


def run_libcosim(
    path: Path, start: dict[str, float], step: float, count: int
) -> tuple[list[float], np.ndarray]:
    """Times before each of count steps [s], and outputs after it; libcosim counts in whole nanoseconds."""
    cosim = pytest.importorskip("libcosimpy.CosimExecution", reason="libcosimpy is not installed")
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    execution = cosim.CosimExecution.from_step_size(step_size=round(1e9 * step))
    slave = CosimLocalSlave(fmu_path=str(path), instance_name="contact")
    index = execution.add_local_slave(local_slave=slave)
    references = {variable.name.decode(): variable.reference for variable in execution.slave_variables(index)}
    for name, value in start.items():
        execution.real_initial_value(index, references[name], value)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    rows = []
    for _ in range(count):
        assert execution.step()
        wanted = [references[name] for name in OUTPUTS]
        rows.append(observer.last_real_values(slave_index=index, variable_references=wanted))
    return [k * round(1e9 * step) / 1e9 for k in range(count)], np.array(rows)


def run_ecos(path: Path, start: dict[str, float], step: float, count: int) -> tuple[list[float], np.ndarray]:
    """Times before each of count steps [s], and samples of the outputs after it."""
    ecos = pytest.importorskip("ecospy", reason="ecospy is not installed", exc_type=(ImportError, OSError))
    times, rows = [], []
    with ecos.EcosSimulationStructure() as structure:
        structure.add_model("contact", str(path))
        structure.add_parameter_set("start", {f"contact::{name}": value for name, value in start.items()})
        with ecos.EcosSimulation(structure=structure, step_size=step) as simulation:
            assert simulation.init(parameter_set="start")
            for _ in range(count):
                times.append(simulation.get_time())
                simulation.step(1)
                rows.append([simulation.get_real(f"contact::{name}") for name in OUTPUTS])
    return times, np.array(rows)


@pytest.mark.parametrize("run_other", [run_libcosim, run_ecos])
def test_libcosim_and_ecos_agree_with_fmpy(
    fmu_path: Path, fmu: FrictionFmu, run_other: Callable[..., tuple[list[float], np.ndarray]]
) -> None:
    """In the scene, and at the same times to the last bit, since F_t turns within 1e-8 s."""
    _, rows = run_other(fmu_path, SCENE, STEP, STEPS)
    assert rows[-1, OUTPUTS.index("F_t_mean")] == MEAN
    start, step = start_values(TABLE_2[1], IDENTIFIED), 5e-7
    times, by_other = run_other(fmu_path, start, step, 200)
    rows = []
    with fmu.session(start) as session:
        for k, time in enumerate(times):
            session.time = time
            session.step(times[k + 1] - time if run_other is run_libcosim and k < 199 else step)
            rows.append(session.read())
    scale = np.abs(rows).max(axis=0)
    assert scale.all() and (np.abs(by_other - np.array(rows)).max(axis=0) <= 1e-12 * scale).all()


def test_the_library_of_this_processor_is_taken_before_another_of_the_system(
    fmu_path: Path, repacked: Callable[..., Path]
) -> None:
    """FMPy's name of the folder does not tell processors apart: on ARM it is linux64, which is x86-64's."""

    def add(entries: dict[str, bytes]) -> None:
        for name in [name for name in entries if f"binaries/{fmpy.platform}/" in name]:
            entries[name.replace(fmpy.platform, fmpy.platform_tuple, 1)] = entries[name]
            entries[name] = b"of another processor"

    both, scene = repacked(add), {"V": 0.5, "vibration.V_1": 1.44}
    expected = simulate_many(scene, fmu=fmu_path)["F_t_mean"]
    assert simulate_many(scene, fmu=both)["F_t_mean"] == expected
    with FrictionFmu(both) as fmu, fmu.session({**scene, **SETTLED}) as session:
        session.step(1.0 / 20e3)
        assert session.get("F_t_mean") == expected
