"""What the FMU holds beside the model: its manifest, parameter sets, reference results and terminals.

tests/release/test_verify.py has that the FMU meets them.
"""

from __future__ import annotations

import zipfile
from io import BytesIO
from pathlib import Path

import fmpy
import numpy as np
import pytest
from lxml import etree

from tools.packing.archive import CHECKSUMS
from tools.presets import presets
from tools.related import COLUMNS, FOLDER, Experiment, experiments, rows

IN_FMU = "extra/org.fmi-standard.fmi-ls-ref"
SCHEMAS = Path(fmpy.__file__).parent
SSV_SCHEMA = SCHEMAS / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
FMI_SCHEMAS = SCHEMAS / "schema" / "fmi3"
TYPES = {  # by role, of FMI-LS-REF 1.0.0-beta.1
    "result": "text/csv",
    "parameter": "application/x-ssp-parameter-set",
    "experiment/validation": "application/x-ma-hs-experiments",
    "meta-data": "text/plain",
}
RUNS = [pytest.param(run, id=run.name) for run in experiments()]


@pytest.fixture(scope="module")
def packed(fmu_path: Path) -> dict[str, bytes]:
    """The files in the FMU, by their names in the folder."""
    with zipfile.ZipFile(fmu_path) as archive:
        return {
            name.removeprefix(f"{IN_FMU}/"): archive.read(name)
            for name in archive.namelist()
            if name.startswith(f"{IN_FMU}/")
        }


def test_the_fmu_holds_them_as_they_are(packed: dict[str, bytes]) -> None:
    checksums = CHECKSUMS.removeprefix(f"{IN_FMU}/")
    assert packed == {path.name: path.read_bytes() for path in FOLDER.iterdir()} | {
        checksums: packed[checksums]
    }


def test_the_manifest_lists_every_file_once(packed: dict[str, bytes]) -> None:
    root = etree.fromstring(packed["fmi-ls-manifest.xml"])
    names = {etree.QName(name).localname: value for name, value in root.items()}
    assert (names["fmi-ls-name"], names["fmi-ls-version"]) == ("org.fmi-standard.fmi-ls-ref", "1.0.0-beta.1")
    assert all(TYPES[each.get("role")] == each.get("type") for each in root)
    assert sorted(["fmi-ls-manifest.xml", *(each.get("source") for each in root)]) == sorted(packed)


def test_the_terminals_are_pairs_of_signals(fmu_path: Path) -> None:
    schema = etree.XMLSchema(etree.parse(FMI_SCHEMAS / "fmi3TerminalsAndIcons.xsd"))
    with zipfile.ZipFile(fmu_path) as archive:
        root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    schema.assertValid(root)
    pairs = [
        (each.get("variableName"), each.get("memberName")) for each in root.iter("TerminalMemberVariable")
    ]
    assert pairs == [("V", "velocity"), ("F_t", "force"), ("V_y", "velocity"), ("F_y", "force")]


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


@pytest.mark.parametrize("run", RUNS)
def test_the_results_are_the_reference_s(run: Experiment) -> None:
    """The first rows computed anew, the rest by rows that follow from the one before."""
    stored = np.genfromtxt(run.result, delimiter=",", names=True)
    assert stored.dtype.names == COLUMNS
    assert len(stored) == round(run.stop / run.step) + 1
    for computed, line in zip(rows(run), stored[:8], strict=False):
        np.testing.assert_allclose(list(computed.values()), list(line), rtol=1e-14)
