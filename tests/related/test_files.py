"""What the FMU holds beside the model: its manifest, parameter sets, reference results and terminals.

tests/examples/test_check_reference.py has that the FMU meets them.
"""

from __future__ import annotations

import zipfile
from io import BytesIO
from pathlib import Path

import fmpy
import numpy as np
import pytest
from lxml import etree

from workshop.packing.archive import CHECKSUMS
from workshop.presets import presets
from workshop.related.results import COLUMNS, FOLDER, Experiment, experiments, rows

IN_FMU = "extra/org.fmi-standard.fmi-ls-ref"
SCHEMAS = Path(fmpy.__file__).parent
SSV_SCHEMA = SCHEMAS / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
FMI_SCHEMAS = SCHEMAS / "schema" / "fmi3"
# FMI-LS-REF 1.0.0-beta.1: the roles and types that stand here, and the attributes of every manifest.
MANIFEST_SCHEMA = f"""
<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema" xmlns:ls="http://fmi-standard.org/fmi-ls-manifest">
  <xs:import namespace="http://fmi-standard.org/fmi-ls-manifest"
             schemaLocation="{(FMI_SCHEMAS / "fmi3LayeredStandardManifest.xsd").as_uri()}"/>
  <xs:simpleType name="role"><xs:restriction base="xs:string">
    <xs:pattern value="result|parameter|experiment/validation|meta-data"/>
  </xs:restriction></xs:simpleType>
  <xs:simpleType name="type"><xs:restriction base="xs:string">
    <xs:pattern value="text/(csv|plain)|application/(x-ssp-parameter-set|x-ma-hs-experiments)"/>
  </xs:restriction></xs:simpleType>
  <xs:element name="fmiReferences"><xs:complexType>
    <xs:sequence>
      <xs:element name="Related" maxOccurs="unbounded"><xs:complexType>
        <xs:attribute name="type" type="type" use="required"/>
        <xs:attribute name="source" type="xs:anyURI" use="required"/>
        <xs:attribute name="role" type="role" use="required"/>
        <xs:attribute name="description" type="xs:string" use="required"/>
      </xs:complexType></xs:element>
    </xs:sequence>
    <xs:attribute ref="ls:fmi-ls-name" use="required" fixed="org.fmi-standard.fmi-ls-ref"/>
    <xs:attribute ref="ls:fmi-ls-version" use="required" fixed="1.0.0-beta.1"/>
    <xs:attribute ref="ls:fmi-ls-description" use="required"/>
  </xs:complexType></xs:element>
</xs:schema>
"""
TYPES = {
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


def test_the_manifest_is_valid_and_lists_every_file_once(packed: dict[str, bytes]) -> None:
    root = etree.fromstring(packed["fmi-ls-manifest.xml"])
    etree.XMLSchema(etree.fromstring(MANIFEST_SCHEMA)).assertValid(root)
    assert sorted(["fmi-ls-manifest.xml", *(each.get("source") for each in root)]) == sorted(packed)
    assert all(TYPES[each.get("role")] == each.get("type") for each in root)


def test_the_terminals_are_pairs_of_signals(fmu_path: Path) -> None:
    schema = etree.XMLSchema(etree.parse(FMI_SCHEMAS / "fmi3TerminalsAndIcons.xsd"))
    with zipfile.ZipFile(fmu_path) as archive:
        root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    schema.assertValid(root)
    pairs = {
        terminal.get("name"): [(each.get("variableName"), each.get("memberName")) for each in terminal]
        for terminal in root.iter("Terminal")
    }
    assert pairs == {
        "along": [("V", "velocity"), ("F_t", "force")],
        "across": [("V_y", "velocity"), ("F_y", "force")],
    }


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
    root = etree.fromstring(packed["validation.exp"])
    assert root.tag == "Experiments" and set(root.keys()) == {"name", "description"}
    for element in root:
        assert {part.tag: part.get("source") in packed for part in element}["References"]
        has_values = bool(next(run for run in experiments() if run.name == element.get("name")).values)
        assert [part.get("source") for part in element.iter("Parameters")] == (
            [f"{element.get('name')}.ssv"] if has_values else []
        )
        steps = float(element.get("stopTime")) / float(element.get("stepSize"))
        assert steps == pytest.approx(round(steps)) and steps < 1000  # fmpy thins out longer runs


@pytest.mark.parametrize("run", RUNS)
def test_the_results_are_the_reference_s(run: Experiment) -> None:
    """The first rows computed anew, the rest by rows that follow from the one before."""
    stored = np.genfromtxt(run.result, delimiter=",", names=True)
    assert stored.dtype.names == COLUMNS
    assert len(stored) == round(run.stop / run.step) + 1
    for computed, line in zip(rows(run), stored[:8], strict=False):
        np.testing.assert_allclose(list(computed.values()), list(line), rtol=1e-14)
