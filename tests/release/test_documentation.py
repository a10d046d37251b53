"""The page inside the FMU: whole, offline, and within the window from phone to desktop."""

from __future__ import annotations

import contextlib
import html
import re
import zipfile
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from playwright.sync_api import Browser

from workshop.fmu_docs import page as fmu_documentation

ROOT = Path(__file__).resolve().parents[2]
VOID = {"meta", "link", "br", "img", "input", "hr"}


@pytest.fixture(scope="module")
def page() -> str:
    return fmu_documentation.page(ROOT / "modelDescription.xml")


def test_the_fmu_holds_this_page(fmu_path: Path, page: str) -> None:
    with zipfile.ZipFile(fmu_path) as archive:
        assert archive.read("documentation/index.html").decode() == page
        names = archive.namelist()
    for link in re.findall(r'href="(licenses/[^"]+)"', page):
        assert f"documentation/{link}" in names


def test_every_variable_is_described(page: str) -> None:
    variables = ElementTree.parse(ROOT / "modelDescription.xml").findall("ModelVariables/ScalarVariable")
    assert len(variables) > 30
    for variable in variables:
        assert f"<code>{variable.attrib['name']}</code></th>" in page
        assert html.escape(variable.attrib["description"]) in page


def test_starts_are_given_in_display_units(page: str) -> None:
    row = re.search(r"<code>contact.R_q</code></th>(.*)</tr>", page)
    assert row is not None
    assert ">6 µm<" in row[1] and ">≥ 1e-12<" in row[1]
    row = re.search(r"<code>solver.method</code></th>(.*)", page)
    assert row is not None
    assert ">collocation<" in row[1] and ">1 … 6<" in row[1]


def test_tags_are_balanced(page: str) -> None:
    open_tags: list[str] = []

    class Balance(HTMLParser):
        def handle_starttag(self, tag: str, attrs: object) -> None:
            if tag not in VOID:
                open_tags.append(tag)

        def handle_endtag(self, tag: str) -> None:
            assert open_tags.pop() == tag, self.getpos()

        def handle_startendtag(self, tag: str, attrs: object) -> None:
            pass

    Balance().feed(page)
    assert open_tags == []


def test_nothing_is_loaded_from_elsewhere(page: str) -> None:
    assert not re.search(r"""(src|href|url)\s*[=(]\s*["']?\s*(https?:|//)""", page)
    assert "<script" not in page and "@import" not in page
    assert page.count("<math") > 10 and page.count("<svg") == 2


@pytest.mark.parametrize("width", [340, 768, 1280])
def test_page_fits_the_window(browser: Browser, page: str, width: int) -> None:
    """No sideways scrolling of the page, and a readable amount of text in it."""
    with contextlib.closing(browser.new_page(viewport={"width": width, "height": 800})) as window:
        window.set_content(page)
        root = "document.documentElement"
        scroll, client = window.evaluate(f"[{root}.scrollWidth, {root}.clientWidth]")
        shown = "all => all.filter(one => one.getBoundingClientRect().height > 5).length"
        formulas = window.locator("math").evaluate_all(shown)
    assert client == width and scroll <= client
    assert formulas == page.count("<math")
