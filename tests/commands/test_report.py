"""scripts/report: the page is whole, needs no network and no script."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from frictioncontact.command import main
from workshop.report import command as report

SECTIONS = (
    "claims",
    "table-2",
    "figures",
    "heights-and-load",
    "regimes-and-limits",
    "sensitivities",
    "errata",
    "identification",
)


@pytest.fixture(scope="module")
def index(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report")
    main(report, ["--quick", "--fmu", str(fmu_path), "--output", str(folder)])
    return folder / "index.html"


@pytest.fixture(scope="module")
def body(index: Path) -> str:
    return index.read_text(encoding="utf-8")


def test_every_section_and_figure_is_there(body: str) -> None:
    assert re.findall(r'<section id="([^"]+)"', body) == list(SECTIONS)
    for number in (2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13):
        assert f'<figure id="fig-{number:02}">' in body
    assert "{{" not in body


def test_every_figure_is_drawn_beside_the_page(index: Path, body: str) -> None:
    sources = re.findall(r'src="([^"]+)"', body)
    assert len(sources) > 15
    assert {path.name for path in index.parent.glob("*.svg")} == set(sources)
    assert "<script" not in body and "://" not in re.sub(r"xmlns\S+|<code>.*?</code>", "", body)


def test_errata_are_all_there(body: str) -> None:
    text = (Path(__file__).resolve().parents[2] / "docs" / "errata.md").read_text(encoding="utf-8")
    assert body.count("<h4>", body.index('id="errata"'), body.index('id="identification"')) == text.count(
        "\n### "
    )


def test_output_that_cannot_be_written_is_named(fmu_path: Path, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(SystemExit, match=f"error: {re.escape(str(blocked))}"):
        main(report, ["--quick", "--fmu", str(fmu_path), "--output", str(blocked)])
