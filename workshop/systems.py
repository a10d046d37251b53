"""A system of FMUs as one .ssp file, and its runs by two importers: libcosim and fmpy.

Both are Jacobi masters: in every step all FMUs advance by themselves with the inputs held, then the outputs
are passed on. Times of libcosim are whole nanoseconds.
"""

import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from libcosimpy.CosimEnums import CosimVariableType
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
from lxml import etree

from frictioncontact.errors import UserError
from frictioncontact.files import whole_file

SSV = "{http://ssp-standard.org/SSP1/SystemStructureParameterValues}"
SSD = "{http://ssp-standard.org/SSP1/SystemStructureDescription}"
Signal = tuple[str, str]  # component, variable


def write_ssp(description: str, fmus: Sequence[Path], output: Path) -> Path:
    """Packs a SystemStructure.ssd (its text) with its FMUs."""
    with whole_file(output) as unfinished, zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", description)
        for fmu in fmus:
            archive.write(fmu, f"resources/{fmu.name}")
    return output


def parameters(description: str) -> dict[Signal, float]:
    """The start values that a SystemStructure.ssd gives its components."""
    found = {}
    for component in etree.fromstring(description.encode()).iter(f"{SSD}Component"):
        for parameter in component.iter(f"{SSV}Parameter"):
            value = parameter.find(f"{SSV}Real").get("value")
            found[component.get("name"), parameter.get("name")] = float(value)
    return found


def with_parameters(description: str, values: Mapping[Signal, float]) -> str:
    """The SystemStructure.ssd with other start values in place of its own."""
    root = etree.fromstring(description.encode())
    for (name, variable), value in values.items():
        (found,) = (
            parameter
            for component in root.iter(f"{SSD}Component")
            for parameter in component.iter(f"{SSV}Parameter")
            if (component.get("name"), parameter.get("name")) == (name, variable)
        )
        found.find(f"{SSV}Real").set("value", repr(float(value)))
    return etree.tostring(root, encoding="unicode")


def run_libcosim(ssp: Path, step_ns: int, count: int, signals: Sequence[Signal]) -> dict[Signal, np.ndarray]:
    """The signals after each of count steps, run by libcosim from the .ssp file."""
    log_output_level(CosimLogLevel.ERROR)
    with zipfile.ZipFile(ssp) as archive:  # libcosim wants the folder
        folder = ssp.with_suffix("")
        archive.extractall(folder)
    execution = CosimExecution.from_ssp_file(str(folder), step_ns)
    observer = CosimObserver.create_time_series(count + 1)
    execution.add_observer(observer)
    references = {}
    for component, variable in signals:
        slave = execution.slave_index_from_instance_name(component)
        names = {entry.name.decode(): entry.reference for entry in execution.slave_variables(slave)}
        references[component, variable] = slave, names[variable]
        observer.start_time_series(slave, names[variable], CosimVariableType.REAL)
    if not execution.step(count):
        raise UserError(f"libcosim stopped at {execution.status().current_time * 1e-9:g} s")
    samples = {
        signal: np.array(observer.time_series_real_samples(slave, reference, 1, count)[2])
        for signal, (slave, reference) in references.items()
    }
    for (component, variable), values in samples.items():
        if len(values) != count:
            raise UserError(f"{component}.{variable}: {len(values)} samples of {count}")
    return samples


def run_fmpy(ssp: Path, step: float, count: int, signals: Sequence[Signal]) -> dict[Signal, np.ndarray]:
    """The same by fmpy, which leaves the start values of the .ssd to its caller, and inputs at 0 at first."""
    with zipfile.ZipFile(ssp) as archive:
        given = parameters(archive.read("SystemStructure.ssd").decode())
    values = [SimpleNamespace(name=".".join(signal), value=value) for signal, value in given.items()]
    result = simulate_ssp(
        str(ssp),
        stop_time=(count - 0.5) * step,
        step_size=step,
        parameter_set=SimpleNamespace(parameters=values),
    )
    return {signal: result[".".join(signal)] for signal in signals}
