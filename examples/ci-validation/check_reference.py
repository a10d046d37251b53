"""Holds an FMU against the reference results that it carries; exit status 1 if a result is missed.

    check_reference.py FrictionContact.fmu            the file, or the folder it was unpacked into

Works for any FMU with experiments of the layered standard FMI-LS-REF (1.0.0-beta.1) that have reference
results (.csv), with or without a parameter set (.ssv). A column is met when no row is further from the
reference than the experiment's tolerance times the column's largest value.

Made to be copied: it needs fmpy only.
"""

from __future__ import annotations

import argparse
import posixpath
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.model_description import ModelDescription

FOLDER = Path("extra") / "org.fmi-standard.fmi-ls-ref"
MANIFEST = FOLDER / "fmi-ls-manifest.xml"
SSV = "{http://ssp-standard.org/SSP1/SystemStructureParameterValues}"


class CheckError(Exception):
    """The FMU can't be checked; the text is one line that says why."""


@dataclass(frozen=True)
class Column:
    """One column of one experiment: largest deviation and the bound, in the unit of the variable."""

    experiment: str
    name: str
    deviation: float
    bound: float

    @property
    def is_met(self) -> bool:
        return self.deviation <= self.bound


def check(fmu: Path) -> list[Column]:
    """All columns of all experiments of an FMU, packed or not; CheckError if it has none or can't be run."""
    if fmu.is_dir():
        return list(_columns(fmu.resolve()))
    if not zipfile.is_zipfile(fmu):
        raise CheckError(f"{fmu} is no FMU: not a zip archive")
    with tempfile.TemporaryDirectory(prefix="check-reference-") as folder:
        return list(_columns(Path(extract(str(fmu), unzipdir=folder))))


def _columns(folder: Path) -> Iterator[Column]:
    files = _experiment_files(folder)
    if not files:
        raise CheckError(f"no experiment is listed in {MANIFEST}")
    description = read_model_description(str(folder), validate=False)
    for file in files:
        for experiment in _read(ElementTree.parse, file).getroot().iterfind("Experiment"):
            yield from _compare(folder, description, file.parent, experiment)


def _experiment_files(folder: Path) -> list[Path]:
    root = _read(ElementTree.parse, folder / MANIFEST).getroot()
    return [
        folder / FOLDER / posixpath.normpath(related.attrib["source"])
        for related in root.iterfind("Related")
        if related.attrib["role"].split("/")[0] == "experiment"
    ]


def _compare(
    folder: Path, description: ModelDescription, here: Path, experiment: ElementTree.Element
) -> Iterator[Column]:
    name = experiment.attrib["name"]
    start, stop, tolerance, step = (
        float(experiment.attrib[key]) for key in ("startTime", "stopTime", "tolerance", "stepSize")
    )
    references, parameters = experiment.find("References"), experiment.find("Parameters")
    if references is None:
        raise CheckError(f"experiment {name} has no reference results")
    expected = _read(_read_csv, here / references.attrib["source"])
    columns = [column for column in expected.dtype.names if column != "time"]
    messages: list[str] = []
    try:
        result = simulate_fmu(
            str(folder),
            model_description=description,
            start_time=start,
            stop_time=stop,
            relative_tolerance=tolerance,
            output_interval=step,
            start_values={}
            if parameters is None
            else _parameters(here / parameters.attrib["source"], description),
            output=columns,
            logger=lambda environment, instance, status, category, text: messages.append(text.decode()),
        )
    except Exception as error:  # fmpy has no class of its own for what it can't load
        raise CheckError(f"experiment {name}: {messages[-1] if messages else error}") from None
    if len(result) != len(expected) or np.max(np.abs(result["time"] - expected["time"])) > 1e-9 * stop:
        raise CheckError(f"experiment {name}: the communication points are not those of the reference")
    for column in columns:
        deviation = float(np.max(np.abs(result[column] - expected[column])))
        yield Column(name, column, deviation, tolerance * float(np.max(np.abs(expected[column]))))


def _parameters(path: Path, description: ModelDescription) -> dict[str, str]:
    """Start values as fmpy takes them: of an enumeration the number of the item, where SSP has its name."""
    items = {
        variable.name: {item.name: item.value for item in variable.declaredType.items}
        for variable in description.modelVariables
        if variable.type == "Enumeration"
    }
    root = _read(ElementTree.parse, path).getroot()
    values = {
        parameter.attrib["name"]: parameter[0].attrib["value"]
        for parameter in root.iterfind(f"{SSV}Parameters/{SSV}Parameter")
    }
    return {name: items.get(name, {}).get(value, value) for name, value in values.items()}


def _read_csv(path: Path) -> np.ndarray:
    return np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True, deletechars=""))


def _read(reader: Callable[[Path], Any], path: Path) -> Any:
    try:
        return reader(path)
    except OSError as error:
        raise CheckError(f"{path.name} can't be read: {error.strerror}") from None
    except (ElementTree.ParseError, ValueError) as error:
        raise CheckError(f"{path.name} can't be read: {error}") from None


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("fmu", type=Path)
    try:
        columns = check(parser.parse_args().fmu)
    except CheckError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        sys.exit(f"error: {error.filename}: {error.strerror}")
    for column in columns:
        word = "ok    " if column.is_met else "MISSED"
        print(f"{word} {column.experiment}: {column.name}: {column.deviation:.2g}, bound {column.bound:.2g}")
    met = sum(column.is_met for column in columns)
    print(f"{met} of {len(columns)} results as in the reference")
    sys.exit(met < len(columns))


if __name__ == "__main__":
    main()
