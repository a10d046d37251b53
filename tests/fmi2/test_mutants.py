"""scripts/check mutants spoils a function for every capability that modelDescription.xml claims."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from frictionlab.check import tokens
from frictionlab.check.mutants import MUTANTS, Mutant, mutated
from frictionlab.check.random_mutants import survivors
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


CODE = """\
#define MANY 4 // 1 + 1
static double f(const double* x) {
    assert(x[0] > 0.0);
    const char* text = "a + b";
    return -x[1] * fmin(x[2], 1.5) <= 2.0; // 3 - x
}
"""


def test_single_tokens_of_code_are_spoilt_and_nothing_else() -> None:
    changed = {
        tokens.line_at(spoilt, site.begin)[1]
        for site in tokens.sites("f.c", CODE)
        for spoilt in [tokens.mutated(CODE, site)]
    }
    end = "; // 3 - x"
    assert changed == {
        f"return {expression}{end}"
        for expression in (
            "x[1] * fmin(x[2], 1.5) <= 2.0",
            "-x[2] * fmin(x[2], 1.5) <= 2.0",
            "-x[0] * fmin(x[2], 1.5) <= 2.0",
            "-x[1] / fmin(x[2], 1.5) <= 2.0",
            "-x[1] + fmin(x[2], 1.5) <= 2.0",
            "-x[1] * fmax(x[2], 1.5) <= 2.0",
            "-x[1] * fmin(x[3], 1.5) <= 2.0",
            "-x[1] * fmin(x[1], 1.5) <= 2.0",
            "-x[1] * fmin(x[2], (1.5 * 1.01)) <= 2.0",
            "-x[1] * fmin(x[2], (1.5 * 0.5)) <= 2.0",
            "-x[1] * fmin(x[2], 0.0) <= 2.0",
            "-x[1] * fmin(x[2], 1.5) < 2.0",
            "-x[1] * fmin(x[2], 1.5) >= 2.0",
            "-x[1] * fmin(x[2], 1.5) <= (2.0 * 1.01)",
            "-x[1] * fmin(x[2], 1.5) <= (2.0 * 0.5)",
            "-x[1] * fmin(x[2], 1.5) <= 0.0",
        )
    }


def test_survivors_are_mutants_of_the_code_as_it_stands() -> None:
    for survivor in survivors():
        assert survivor.reason
        text = (ROOT / "fmu_src" / survivor.file).read_text()
        possible = {
            (tokens.line_at(text, site.begin)[1], tokens.line_at(tokens.mutated(text, site), site.begin)[1])
            for site in tokens.sites(survivor.file, text)
        }
        assert (survivor.line, survivor.replacement) in possible, survivor
