"""The report page in headless Chromium: screenshots, and what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from workshop.browser import chromium, watch

WIDTHS = {"phone": 390, "tablet": 820, "desktop": 1440}
DRAW_ALL = "(boxes.forEach(draw), boxes.every((box) => box.querySelector('.main-svg')))"


@dataclass(frozen=True)
class Visit:
    """What one visit of the page found."""

    width: int
    scroll_width: int
    drawn: bool
    problems: list[str]  # errors, warnings, requests beyond the page


def visit(
    page: Path, width: int, dark: bool, screenshot: Path | None = None, tall: int | None = None
) -> Visit:
    """Opens the page at a width [px]; a screenshot is of the whole page or of its first tall px."""
    problems: list[str] = []

    scheme = "dark" if dark else "light"
    with chromium() as browser:
        tab = browser.new_page(
            viewport={"width": width, "height": 900}, color_scheme=scheme, is_mobile=width < 600
        )
        watch(tab, page, problems)
        tab.goto(page.resolve().as_uri())
        drawn = tab.evaluate(DRAW_ALL)
        tab.wait_for_timeout(400)
        scroll_width = tab.evaluate("document.documentElement.scrollWidth")
        theme = tab.evaluate("document.documentElement.dataset.theme")
        if screenshot is not None:
            height = tab.evaluate("document.documentElement.scrollHeight")
            clip = {"x": 0, "y": 0, "width": width, "height": min(height, tall or height)}
            tab.screenshot(path=screenshot, full_page=True, clip=clip)
    if theme != scheme:
        problems.append(f"the page is {theme}, not what the reader prefers")
    return Visit(width, scroll_width, bool(drawn), problems)
