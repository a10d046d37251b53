"""scripts/report: the page is whole, needs no network, and draws at every width, light and dark."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from workshop.browser import find_browser
from workshop.report import browser as report_browser
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
    report.main(["--quick", "--fmu", str(fmu_path), "--output", str(folder)])
    return folder / "index.html"


@pytest.fixture(scope="module")
def body(index: Path) -> str:
    """The page without the plotting library, which names addresses that it never calls."""
    text = index.read_text(encoding="utf-8")
    return text[: text.index('<script id="panels"')]


def test_every_section_and_figure_is_there(body: str) -> None:
    assert re.findall(r'<section id="([^"]+)"', body) == list(SECTIONS)
    for number in (2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13):
        assert f'<figure id="fig-{number:02}">' in body
    assert "{{" not in body


def test_every_plot_has_its_data(index: Path, body: str) -> None:
    text = index.read_text(encoding="utf-8")
    data = json.loads(re.search(r'<script id="panels" type="application/json">(.*?)</script>', text, re.S)[1])
    boxes = re.findall(r'data-panel="([^"]+)"', body)
    assert sorted(boxes) == sorted(data)
    assert len(boxes) > 30
    assert all(panel["traces"] for panel in data.values())


def test_table_2_has_the_three_numbers(body: str) -> None:
    table = re.search(r'<section id="table-2">.*?</section>', body, re.S)[0]
    rows = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in re.findall(r"<tr>(.*?)</tr>", table, re.S)[1:]]
    assert [row[1] for row in rows] == ["55", "21", "27", "48", "54", "28"]
    assert [row[3] for row in rows] == ["55.0000", "0.1216", "0.1216", "55.0000", "55.0000", "0.1523"]
    assert [row[5] for row in rows] == ["55.00", "21.56", "26.44", "55.00", "55.00", "27.44"]


def test_claims_have_what_the_equations_give(body: str) -> None:
    table = re.search(r'<section id="claims">.*?</section>', body, re.S)[0]
    exact = [
        re.findall(r"<td[^>]*>(.*?)</td>", row)[2] for row in re.findall(r"<tr>(.*?)</tr>", table, re.S)[1:]
    ]
    assert exact == ["−99.78", "−99.78", "0", "0", "+7.71", "+50.68"]


def test_errata_are_all_there(body: str) -> None:
    text = (Path(__file__).resolve().parents[2] / "docs" / "errata.md").read_text(encoding="utf-8")
    assert body.count("<h4>", body.index('id="errata"'), body.index('id="identification"')) == text.count(
        "\n### "
    )


def test_page_loads_nothing(body: str) -> None:
    assert not re.search(r'(?:src|href)\s*=\s*"(?!#|data:)', body)
    assert "@import" not in body
    assert "url(" not in body


@pytest.mark.parametrize(
    ("width", "dark"),
    [
        (360, True),
        pytest.param(820, False, marks=pytest.mark.slow),
        pytest.param(1440, False, marks=pytest.mark.slow),
    ],
)
def test_browser_draws_it_all(index: Path, width: int, dark: bool) -> None:
    if find_browser() is None:
        pytest.skip("no Chromium on this machine: the report page is not looked at")
    seen = report_browser.visit(index, width, dark)
    assert seen.problems == []
    assert seen.drawn
    assert seen.scroll_width <= width


def test_browser_finds_what_is_wrong(tmp_path: Path) -> None:
    if find_browser() is None:
        pytest.skip("no Chromium on this machine: the report page is not looked at")
    page = tmp_path / "broken.html"
    page.write_text(
        '<html data-theme="light"><body><img src="http://127.0.0.1:9/x.png">'
        '<div style="width:900px">wide</div>'
        "<script>const boxes = []; const draw = () => 0; nothing();</script></body></html>"
    )
    seen = report_browser.visit(page, 390, dark=False)
    assert any("request: http://127.0.0.1:9/x.png" in problem for problem in seen.problems)
    assert any("script error" in problem for problem in seen.problems)
    assert seen.scroll_width > 390


def test_output_that_cannot_be_written_is_named(fmu_path: Path, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(SystemExit, match=f"error: {re.escape(str(blocked))}"):
        report.main(["--quick", "--fmu", str(fmu_path), "--output", str(blocked)])
