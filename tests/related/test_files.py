"""What the FMU holds beside the model: its manifest, its parameter sets, and reference results.

tests/examples/test_check_reference.py has that the FMU meets them.
"""

from __future__ import annotations

import re
import zipfile
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from lxml import etree

from workshop.presets import presets
from workshop.related.experiments import Experiment, experiments
from workshop.related.files import CHECKSUMS, EXPERIMENTS, FOLDER, LAYERED, MANIFEST, STANDARD, files
from workshop.related.results import COLUMNS, rows

SSV_SCHEMA = Path(fmpy.__file__).parent / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
# The roles that FMI-LS-REF 1.0.0-alpha.1 knows and that stand here.
TYPES = {
    "result": "text/csv",
    "parameter": "application/x-ssp-parameter-set",
    "experiment/validation": "application/x-ma-ls-experiments",
    "meta-data": "text/plain",
}
RUNS = [pytest.param(run, id=run.name) for run in experiments()]


@pytest.fixture(scope="module")
def packed(fmu_path: Path) -> dict[str, bytes]:
    """The files in the FMU, by their names in the folder."""
    with zipfile.ZipFile(fmu_path) as archive:
        return {
            name.removeprefix(f"{FOLDER}/"): archive.read(name)
            for name in archive.namelist()
            if name.startswith(f"{FOLDER}/")
        }


def test_the_fmu_holds_them(packed: dict[str, bytes]) -> None:
    assert packed == files() | {CHECKSUMS: packed[CHECKSUMS]}


def test_the_manifest_lists_every_file_once_by_its_role_and_type(packed: dict[str, bytes]) -> None:
    root = ElementTree.fromstring(packed[MANIFEST])
    assert root.tag == "fmiReferences"
    assert root.attrib == {
        f"{{{LAYERED}}}fmi-ls-name": STANDARD,
        f"{{{LAYERED}}}fmi-ls-version": "1.0.0-alpha.1",
        f"{{{LAYERED}}}fmi-ls-description": (
            "Layered Standard providing information on related files included in an FMU."
        ),
    }
    sources = [element.attrib["source"] for element in root]
    assert sorted([*sources, MANIFEST]) == sorted(packed)
    for element in root:
        assert element.tag == "Related"
        assert set(element.attrib) == {"type", "source", "role", "description"}
        assert TYPES[element.attrib["role"]] == element.attrib["type"]
        assert re.fullmatch(r"[\w.-]+", element.attrib["source"])  # a relative URI as it stands


def test_parameter_sets_are_those_of_the_presets(packed: dict[str, bytes]) -> None:
    """Valid by the standard's schema; names, types and values the FMU's."""
    schema = etree.XMLSchema(etree.parse(SSV_SCHEMA))
    sets = {name.removesuffix(".ssv"): packed[name] for name in packed if name.endswith(".ssv")}
    expected = {preset.id: preset for preset in presets()}
    assert sets.keys() == expected.keys() and len(sets) >= 13
    for name, content in sets.items():
        root = etree.parse(BytesIO(content)).getroot()
        schema.assertValid(root)
        found = {
            element.get("name"): float(element[0].get("value"))
            if etree.QName(element[0]).localname == "Real"
            else element[0].get("value")
            for element in root.iterfind("{*}Parameters/{*}Parameter")
        }
        assert found == expected[name].values


def test_the_experiments_name_what_is_there(packed: dict[str, bytes]) -> None:
    root = ElementTree.fromstring(packed[EXPERIMENTS])
    assert root.tag == "Experiments" and root.attrib.keys() == {"name", "description"}
    assert [element.attrib["name"] for element in root] == [run.name for run in experiments()]
    for element in root:
        for part in element:
            assert part.attrib["source"] in packed
        steps = float(element.attrib["stopTime"]) / float(element.attrib["stepSize"])
        assert steps == pytest.approx(round(steps)) and steps < 1000  # fmpy thins out longer runs


@pytest.mark.parametrize("run", RUNS)
def test_the_results_are_the_reference_s(run: Experiment) -> None:
    """The first rows computed anew, the rest by rows that follow from the one before."""
    stored = np.genfromtxt(run.result, delimiter=",", names=True)
    assert stored.dtype.names == COLUMNS
    assert len(stored) == round(run.stop / run.step) + 1
    for computed, line in zip(rows(run), stored[:8], strict=False):
        np.testing.assert_allclose(list(computed.values()), list(line), rtol=1e-14)
