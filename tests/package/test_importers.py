"""The FMU in other hands: fmpy's validator finds nothing; libcosim and Ecos give the numbers of fmpy."""

from __future__ import annotations

import zipfile
from importlib.metadata import version
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

from frictioncontact.batch import simulate_many
from frictioncontact.fmu import OUTPUTS, SETTLED, FrictionFmu, simulate
from frictioncontact.parameters import IDENTIFIED, TABLE_2, start_values
from workshop.project import ROOT


def test_the_page_names_the_versions_that_are_tested() -> None:
    page = (ROOT / "docs" / "compatibility.md").read_text(encoding="utf-8")
    for name, package in {"FMPy": "fmpy", "libcosimpy": "libcosimpy", "Ecos": "ecospy"}.items():
        assert f"{name} {version(package)}" in page


def test_fmpy_validate_finds_nothing(fmu_path: Path) -> None:
    assert validate_fmu(str(fmu_path)) == []


def test_fmpy_sends_no_input_derivatives(fmu_path: Path) -> None:
    """As docs/tools.md says: FMPy's array of derivatives has nine places, whatever the inputs are."""
    drive = np.array([(0.0, 0.1), (1e-3, 0.2)], dtype=[("time", float), ("V", float)])
    with pytest.raises(ValueError, match="sequence of same size"):
        simulate_fmu(str(fmu_path), input=drive, set_input_derivatives=True, stop_time=1e-3)


def test_fmpy_simulate(fmu_path: Path, fmu: FrictionFmu) -> None:
    """fmpy's own loop over the default experiment gives what single steps give."""
    start = start_values(TABLE_2[1], IDENTIFIED)
    result = simulate_fmu(str(fmu_path), start_values=start, output=list(OUTPUTS))
    times = result["time"]
    assert len(times) > 100 and times[-1] == pytest.approx(2e-4, rel=1e-12)
    step = times[1] - times[0]
    run = simulate(fmu, start, step, len(times) - 1)
    for name in OUTPUTS:
        scale = np.abs(run[name]).max()
        assert result[name] == pytest.approx(run[name], rel=1e-9, abs=1e-9 * scale)


def run_libcosim(path: Path, start: dict[str, float], step_ns: int, count: int) -> dict[str, np.ndarray]:
    """Samples of the outputs after each of count steps; libcosim counts time in whole nanoseconds."""
    cosim = pytest.importorskip("libcosimpy.CosimExecution", reason="libcosimpy is not installed")
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    execution = cosim.CosimExecution.from_step_size(step_size=step_ns)
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
        rows.append(
            observer.last_real_values(
                slave_index=index, variable_references=[references[name] for name in OUTPUTS]
            )
        )
    return dict(zip(OUTPUTS, np.array(rows).T, strict=True))


@pytest.mark.parametrize("step_ns", [500, 50_000, 1_000_000])
def test_libcosim_agrees_with_fmpy(fmu_path: Path, fmu: FrictionFmu, step_ns: int) -> None:
    """At the same times to the last bit, since F_t turns within 1e-8 s."""
    start = start_values(TABLE_2[1], IDENTIFIED)
    count = 200
    by_libcosim = run_libcosim(fmu_path, start, step_ns, count)
    times = [k * step_ns / 1e9 for k in range(count + 1)]
    rows = []
    with fmu.session(start) as session:
        for begin, end in zip(times[:-1], times[1:], strict=True):
            session.time = begin
            session.step(end - begin)
            rows.append(session.read())
    for name, by_fmpy in zip(OUTPUTS, np.array(rows).T, strict=True):
        scale = np.abs(by_fmpy).max()
        assert scale > 0
        assert np.abs(by_libcosim[name] - by_fmpy).max() <= 1e-12 * scale, name


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


@pytest.mark.parametrize("step", [5e-7, 5e-5, 1e-3])
def test_ecos_agrees_with_fmpy(fmu_path: Path, fmu: FrictionFmu, step: float) -> None:
    """By fmi4c, a reader and loader of FMUs that has nothing of fmpy's or libcosim's."""
    start = start_values(TABLE_2[1], IDENTIFIED)
    times, by_ecos = run_ecos(fmu_path, start, step, 200)
    rows = []
    with fmu.session(start) as session:
        for time in times:
            session.time = time
            session.step(step)
            rows.append(session.read())
    by_fmpy = np.array(rows)
    scale = np.abs(by_fmpy).max(axis=0)
    assert scale.all()
    assert (np.abs(by_ecos - by_fmpy).max(axis=0) <= 1e-12 * scale).all()


def test_the_library_of_this_processor_is_taken_before_another_of_the_system(
    fmu_path: Path, tmp_path: Path
) -> None:
    """FMPy's name of the folder does not tell processors apart: on ARM it is linux64, which is x86-64's."""
    both = tmp_path / "both.fmu"
    with zipfile.ZipFile(fmu_path) as whole, zipfile.ZipFile(both, "w") as archive:
        for name in whole.namelist():
            exact = name.replace(f"binaries/{fmpy.platform}/", f"binaries/{fmpy.platform_tuple}/")
            archive.writestr(exact, whole.read(name))
            if exact != name:
                archive.writestr(name, b"of another processor")
    scene = {"V": 0.5, "vibration.V_1": 1.44}
    expected = simulate_many(scene, fmu=fmu_path)["F_t_mean"]
    assert simulate_many(scene, fmu=both)["F_t_mean"] == expected
    with FrictionFmu(both) as fmu, fmu.session({**scene, **SETTLED}) as session:
        session.step(1.0 / 20e3)
        assert session.get("F_t_mean") == expected
