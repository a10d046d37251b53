"""scripts/check mutants spoils a function for every capability that modelDescription.xml claims."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from frictionlab.check.mutants import MUTANTS, Mutant, mutated
from frictionlab.project import ROOT


def test_every_capability_has_a_mutant(unzipped_fmu: Path) -> None:
    description = ElementTree.parse(unzipped_fmu / "modelDescription.xml").getroot()
    claimed = set(description.find("CoSimulation").attrib) - {"modelIdentifier"}  # type: ignore[union-attr]
    assert claimed <= {mutant.flag for mutant in MUTANTS}


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.title)
def test_the_place_to_spoil_is_there(mutant: Mutant) -> None:
    source = (ROOT / "fmu_src" / mutant.source).read_text()
    assert mutated(source, mutant) != source
    assert all((ROOT / tests).is_file() for tests in mutant.tests.split())
