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
    places = _places(etree.fromstring(description.encode()))
    return {signal: float(place.get("value")) for signal, place in places.items()}


def _places(root: etree._Element) -> dict[Signal, etree._Element]:
    """Of the start values of components."""
    return {
        (component.get("name"), parameter.get("name")): parameter.find(f"{SSV}Real")
        for component in root.iter(f"{SSD}Component")
        for parameter in component.iter(f"{SSV}Parameter")
    }


def with_parameters(description: str, values: Mapping[Signal, float]) -> str:
    """The SystemStructure.ssd with other start values in place of its own."""
    root = etree.fromstring(description.encode())
    places = _places(root)
    for signal, value in values.items():
        places[signal].set("value", repr(float(value)))
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
    places = {}
    for component, variable in signals:
        slave = execution.slave_index_from_instance_name(component)
        references = {entry.name.decode(): entry.reference for entry in execution.slave_variables(slave)}
        places[component, variable] = slave, references[variable]
        observer.start_time_series(slave, references[variable], CosimVariableType.REAL)
    if not execution.step(count):
        raise UserError(f"libcosim stopped at {execution.status().current_time * 1e-9:g} s")
    samples = {}
    for signal, place in places.items():
        samples[signal] = np.array(observer.time_series_real_samples(*place, 1, count)[2])
        if len(samples[signal]) != count:
            raise UserError(f"{'.'.join(signal)}: {len(samples[signal])} samples of {count}")
    return samples


def run_fmpy(ssp: Path, step: float, count: int, signals: Sequence[Signal]) -> dict[Signal, np.ndarray]:
    """The same by fmpy, which leaves the start values of the .ssd to its caller, and inputs at 0 at first."""
    with zipfile.ZipFile(ssp) as archive:
        given = parameters(archive.read("SystemStructure.ssd").decode())
    values = [SimpleNamespace(name=".".join(signal), value=value) for signal, value in given.items()]
    times = {"stop_time": (count - 0.5) * step, "step_size": step}
    result = simulate_ssp(str(ssp), parameter_set=SimpleNamespace(parameters=values), **times)
    return {signal: result[".".join(signal)] for signal in signals}
