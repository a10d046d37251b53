"""The page inside the FMU: whole, offline, and within the window from phone to desktop."""

from __future__ import annotations

import contextlib
import html
import posixpath
import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest
from playwright.sync_api import Browser

from tools.packing import documentation as fmu_documentation
from tools.project import ROOT

RELATED = "documentation/fmi-ls-ref.html"


@pytest.fixture(scope="module")
def page() -> str:
    return fmu_documentation.page(ROOT / "modelDescription.xml")


def test_the_fmu_holds_this_page_and_what_it_links(fmu_path: Path, page: str) -> None:
    """And a page that links every related file and nothing else."""
    with zipfile.ZipFile(fmu_path) as archive:
        assert archive.read("documentation/index.html").decode() == page
        names, related = archive.namelist(), archive.read(RELATED).decode()
    links = [
        {posixpath.normpath(f"documentation/{target}") for target in re.findall(r'href="([^"#:]+)"', text)}
        for text in (page, related)
    ]
    assert links[0] <= set(names) and RELATED in links[0]
    files = {name for name in names if "/org.fmi-standard.fmi-ls-ref/" in name and "manifest" not in name}
    assert links[1] == {*files, "documentation/index.html"}


def test_every_variable_is_described(page: str) -> None:
    for variable in ElementTree.parse(ROOT / "modelDescription.xml").findall("ModelVariables/ScalarVariable"):
        assert f"<code>{variable.attrib['name']}</code></th>" in page
        assert html.escape(variable.attrib["description"]) in page
    row = re.search(r"<code>contact.R_q</code></th>(.*)</tr>", page)[1]
    assert ">6 µm<" in row and ">≥ 1e-12<" in row  # the start in the display unit


def test_nothing_is_loaded_from_elsewhere(page: str) -> None:
    assert not re.search(r"""(src|href|url)\s*[=(]\s*["']?\s*(https?:|//)""", page)
    assert "<script" not in page and "@import" not in page


@pytest.mark.parametrize("width", [340, 1280])
def test_page_fits_the_window(browser: Browser, page: str, width: int) -> None:
    """No sideways scrolling of the page, and every formula is seen."""
    with contextlib.closing(browser.new_page(viewport={"width": width, "height": 800})) as window:
        window.set_content(page)
        assert window.evaluate("document.documentElement.scrollWidth") <= width
        shown = "all => all.filter(one => one.getBoundingClientRect().height > 5).length"
        assert window.locator("math").evaluate_all(shown) == page.count("<math") > 10
