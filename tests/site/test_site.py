"""The web site: it builds without a warning, and works in a browser that opens it from a folder."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from lxml import html
from playwright.sync_api import Browser, Page, expect

from frictioncontact.errors import UserError
from tools import description
from tools.browser import PATIENCE, SIZES, watch, window
from tools.project import ROOT
from tools.site.check import broken_links, complaints, pages
from tools.site.command import build
from tools.site.conf import MAINTAINERS

pytest.importorskip("ziglang", reason="the release's packages are not installed: scripts/setup release")
pytestmark = pytest.mark.filterwarnings("ignore::sphinx.deprecation.RemovedInSphinx11Warning")  # of the theme
expect.set_options(timeout=PATIENCE)


@pytest.fixture(scope="module")
def older(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site of an older version: one page."""
    folder = tmp_path_factory.mktemp("older") / "0.1.0"
    folder.mkdir()
    (folder / "index.html").write_text("<!DOCTYPE html><title>0.1.0</title><p>The first version")
    return folder


@pytest.fixture(scope="module")
def site(older: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("web") / "site"
    build(folder, [older])
    return folder


@pytest.fixture
def page(browser: Browser, site: Path, request: pytest.FixtureRequest) -> Iterator[Page]:
    """Fails the test if a page had an error or asked for more than the folder has."""
    heard: list[str] = []
    with window(browser, getattr(request, "param", "desktop")) as opened:
        page = opened.new_page()
        watch(page, site, heard)
        yield page
    assert heard == []


def test_every_page_is_there(site: Path) -> None:
    documents = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/README.md")]
    assert len(documents) > 15
    for document in documents:
        made = (site / document.relative_to(ROOT)).with_suffix(".html")
        title = re.search(r"^# (.*)$", document.read_text(encoding="utf-8"), re.MULTILINE)[1]
        shown = html.parse(str(made)).find(".//h1").text_content()
        assert shown.startswith(title.replace("`", "")), document


def test_every_page_is_whole(site: Path) -> None:
    """Formulas are typeset, the version stands on it, and no path of this machine."""
    version = description.read().version
    for path in {*pages(site)} - {site / "playground.html", site / "0.1.0" / "index.html"}:
        text = path.read_text(encoding="utf-8")
        assert f"FrictionContact {version}" in text and str(ROOT) not in text, path
    assert str(ROOT) not in (site / "searchindex.js").read_text(encoding="utf-8")
    article = html.parse(str(site / "docs" / "physics.html")).getroot().find(".//article")
    assert len(article.findall(".//math")) >= 20 and "$" not in article.text_content()
    api = html.parse(str(site / "docs" / "api.html")).getroot().text_content()
    assert "simulate_many" in api and "Parameters" in api and "threads" in api
    assert '<a href="0.1.0/index.html">' in (site / "CHANGELOG.html").read_text(encoding="utf-8")
    assert (site / "0.1.0" / "index.html").is_file()


def test_links_lead_to_files_and_anchors(site: Path) -> None:
    assert len(pages(site)) > 20
    assert list(broken_links(site)) == []


def test_faults_are_found(tmp_path: Path) -> None:
    faults = {
        '<a href="no.html">': "leads nowhere",
        '<a href="fault.html#no">': "no such anchor",
        '<a href="../outside.html">': "leads nowhere",
        '<img src="https://example.org/a.png">': "loaded from outside",
        '<script src="//example.org/a.js"></script>': "loaded from outside",
    }
    folder = tmp_path / "site"
    folder.mkdir()
    (tmp_path / "outside.html").touch()
    (folder / "fault.html").write_text(f"<!DOCTYPE html>{''.join(faults)}<a href='fault.html'>")
    for line, found in zip(broken_links(folder), faults.values(), strict=True):
        assert found in line


def test_no_page_has_an_error_or_asks_for_anything(site: Path, browser: Browser) -> None:
    assert complaints(browser, site) == []


def test_complaints_are_heard(browser: Browser, tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        '<!DOCTYPE html><div style="width: 5000px">.</div><script>undefined.x</script>'
        '<img src="http://127.0.0.1:9/a.png"><script>console.error("no")</script>'
    )
    heard = " ".join(complaints(browser, tmp_path))
    for words in ("script error", "request: http://127.0.0.1:9", "console: no", "wider than a phone"):
        assert words in heard


@pytest.mark.parametrize("page", SIZES, indirect=True)
def test_search_finds_a_page(page: Page, site: Path) -> None:
    page.goto((site / "index.html").as_uri())
    page.locator(".search-button__button:visible").first.click()
    field = page.locator("dialog input[type=search]")
    field.fill("elasticplastic")
    field.press("Enter")
    hits = page.locator("ul.search li a")
    expect(page.locator("#search-results")).to_contain_text("matching the search query")
    assert any("docs/validation.html" in hit.get_attribute("href") for hit in hits.all())
    hits.first.click()
    expect(page.locator("article")).to_contain_text("ElasticPlastic")


def test_search_finds_a_variable_in_its_table_and_pages_of_users_first(page: Page, site: Path) -> None:
    for name in ("F_t_settled", "F_y_settled"):
        page.goto((site / "search.html").as_uri() + f"?q={name}")
        first = page.locator("ul.search li a").first
        expect(first).to_have_attribute("href", re.compile(r"docs/using\.html#index-\d"))
    page.goto((site / "search.html").as_uri() + "?q=stiffness")
    expect(page.locator("#search-results")).to_contain_text("matching the search query")
    hits = page.locator("ul.search li a").evaluate_all("all => all.map((link) => link.href)")
    last = [f"/{name}.html" for name in MAINTAINERS["Maintainers"].values()]
    of_maintainers = [any(name in hit for name in last) for hit in hits]
    assert any(of_maintainers) and not all(of_maintainers)
    assert of_maintainers == sorted(of_maintainers)


def test_the_menu_names_two_parts(site: Path) -> None:
    menu = html.parse(str(site / "docs" / "using.html")).getroot().find_class("caption-text")
    parts = list(dict.fromkeys(caption.text.split(" · ")[0] for caption in menu))
    assert parts == ["Users", "Maintainers"]


def test_the_playground_lives_in_its_page(page: Page, site: Path) -> None:
    page.goto((site / "docs" / "playground.html").as_uri())
    shown = page.frame_locator("iframe.playground").get_by_text("21.56")  # N, row 2 of Table 2 in the README
    expect(shown.first).to_be_visible()


@pytest.mark.parametrize("page", ["phone"], indirect=True)
def test_the_menu_of_a_phone_leads_on(page: Page, site: Path) -> None:
    page.goto((site / "index.html").as_uri())
    link = page.get_by_role("link", name="Errata", exact=True)
    assert not link.is_visible()
    page.locator("button.primary-toggle").click()
    link.click()
    expect(page.locator("article h1")).to_contain_text("What the paper prints")


@pytest.mark.parametrize("page", ["phone"], indirect=True)
def test_a_phone_shows_every_variable_whole(page: Page, site: Path) -> None:
    """The meaning of a variable needs no scrolling, and a number stands after the heading of its column."""
    page.goto((site / "docs" / "using.html").as_uri())
    boxes = page.locator(".pst-scrollable-table-container")
    assert boxes.count() > 10
    assert boxes.evaluate_all("all => all.every((box) => box.scrollWidth <= box.clientWidth)")
    row = page.locator("tr", has=page.get_by_text("friction.staticRatio", exact=True))
    assert re.search(r"unit 1\s+start 1\s+change tunable\s+meaning ", row.inner_text())


def test_a_folder_with_something_else_stays(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(UserError, match="no site"):
        build(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]
