"""docs/bad-input.md says what the FMU does."""

from __future__ import annotations

from pathlib import Path

from bad_input_page import PAGE, page


def test_the_page_is_what_the_fmu_does(unzipped_fmu: Path) -> None:
    assert PAGE.read_text() == page(unzipped_fmu), "write it anew: scripts/check bad-input"
