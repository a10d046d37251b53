"""Whether the site holds together: its links, and what its pages do in a browser opened from the folder."""

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from urllib.parse import unquote, urlsplit

from lxml import html
from playwright.sync_api import Browser

from tools.browser import SIZES, chromium, watch, window


def problems(folder: Path) -> list[str]:
    """All that is wrong, a line each."""
    with chromium() as browser:
        return [*broken_links(folder), *complaints(browser, folder)]


def pages(folder: Path) -> list[Path]:
    """Those of the site, without the templates that a theme leaves among its scripts."""
    return sorted(path for path in folder.rglob("*.html") if "_static" not in path.parts)


@cache
def _names(page: Path) -> frozenset[str]:
    """The anchors of a page."""
    tree = html.parse(str(page))
    return frozenset([*tree.xpath("//@id"), *tree.xpath("//a/@name")])


def broken_links(folder: Path) -> Iterator[str]:
    """Links to a file or an anchor that is not there, and what is loaded from outside the folder."""
    for page in pages(folder):
        for element, attribute, link, _ in html.parse(str(page)).getroot().iterlinks():
            parts = urlsplit(link)
            where = f"{page.relative_to(folder)}: {link}"
            if parts.scheme in ("data", "javascript", "mailto"):
                continue
            if parts.scheme or parts.netloc:
                if element.tag != "a" and element.get("rel") != "canonical":
                    yield f"{where} is loaded from outside ({element.tag} {attribute})"
                continue
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            if not target.is_file() or not target.is_relative_to(folder.resolve()):
                yield f"{where} leads nowhere"
            elif (
                parts.fragment and target.suffix == ".html" and unquote(parts.fragment) not in _names(target)
            ):
                yield f"{where}: no such anchor"


def complaints(browser: Browser, folder: Path) -> list[str]:
    """What the pages do wrong, opened one by one: errors, requests, text wider than a window of each size."""
    heard: list[str] = []
    with window(browser, "desktop") as opened:
        page = opened.new_page()
        watch(page, folder, heard)
        for path in pages(folder):
            page.goto(path.resolve().as_uri())
            for size, (width, height) in SIZES.items():
                page.set_viewport_size({"width": width, "height": height})
                if page.evaluate("document.documentElement.scrollWidth > window.innerWidth + 1"):
                    heard.append(f"{path.relative_to(folder)}: wider than a {size}")
    return heard
