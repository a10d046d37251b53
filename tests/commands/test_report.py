"""scripts/report: the page is whole, needs no network and no script."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from figures.report import command as report
from frictioncontact.command import main

SECTIONS = (
    "claims table-2 figures heights-and-load regimes-and-limits sensitivities errata identification".split()
)


@pytest.mark.slow
def test_every_section_and_figure_is_there(fmu_path: Path, tmp_path: Path) -> None:
    main(report, ["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path)])
    body = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert re.findall(r'<section id="([^"]+)"', body) == SECTIONS
    for number in (2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13):
        assert f'<figure id="fig-{number:02}">' in body
    sources = re.findall(r'src="([^"]+)"', body)
    assert len(sources) > 15 and {path.name for path in tmp_path.glob("*.svg")} == set(sources)
    assert "{{" not in body and "<script" not in body
    assert "://" not in re.sub(r"xmlns\S+|<code>.*?</code>", "", body)
