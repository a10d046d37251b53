"""The FMU in other hands: fmpy's validator finds nothing, and libcosim gives the same numbers as fmpy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

from frictionlab.fmu import OUTPUTS, FrictionFmu, simulate
from frictionlab.parameters import IDENTIFIED, TABLE_2, start_values


def test_fmpy_validate_finds_nothing(fmu_path: Path) -> None:
    assert validate_fmu(str(fmu_path)) == []


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
