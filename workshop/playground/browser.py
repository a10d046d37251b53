"""The page in a headless Chromium: its pictures, and how long a first picture and a frame take."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, Page

SIZES = {"desktop": (1440, 900), "phone": (390, 844)}  # pixels of CSS
SCHEMES = ("light", "dark")
FRAMES = 120  # that are timed
OPENINGS = 9  # of the page, as well
REST = 1000  # ms; a new window itself starts for about half of that

PICTURE = 'elementtiming="first picture"'  # in page.html: a number that is written with the first figures
PAINTED = """() => new Promise((resolve) => {
    new PerformanceObserver((list) => {
        const picture = list.getEntries().find(({ identifier }) => identifier === "first picture");
        if (picture) resolve(picture.renderTime);
    }).observe({ type: "element", buffered: true });
})"""

# When the controls answered.
READY = """() => performance.getEntriesByName("ready")[0].startTime"""

# Drags a slider over its middle half, one step a frame; gives each frame's work in ms.
DRAG = """async ([variable, frames]) => {
    const slider = document.querySelector(`[data-variable="${variable}"] input[type=range]`);
    performance.clearMeasures("frame");
    for (let k = 0; k < frames; k++) {
        slider.value = slider.max * (0.25 + (0.5 * k) / frames);
        slider.dispatchEvent(new Event("input"));
        await new Promise(requestAnimationFrame);
    }
    return performance.getEntriesByName("frame").map(({ duration }) => duration);
}"""


def opened(browser: Browser, html: Path, size: str, scheme: str) -> Page:
    """The page with all its figures drawn."""
    width, height = SIZES[size]
    context = browser.new_context(
        viewport={"width": width, "height": height},
        color_scheme="dark" if scheme == "dark" else "light",
        device_scale_factor=2 if size == "phone" else 1,
        has_touch=size == "phone",
    )
    page = context.new_page()
    page.goto(html.resolve().as_uri())
    page.wait_for_selector("body.ready[data-worker=done]")
    return page


def take_pictures(browser: Browser, html: Path, folder: Path) -> list[Path]:
    """playground-SIZE-SCHEME.png of the first window of the page."""
    paths = []
    for size in SIZES:
        for scheme in SCHEMES:
            page = opened(browser, html, size, scheme)
            paths.append(folder / f"playground-{size}-{scheme}.png")
            page.screenshot(path=paths[-1])
            page.context.close()
    return paths


def measure(browser: Browser, html: Path, variable: str = "vibration.V_1") -> dict[str, list[float]]:
    """Times [ms] from the start of the navigation, and of a frame's work while a slider is dragged.

    The page and a file of one word are opened in turns, each in a profile without a cache: in a window at
    rest, and in one that was just opened.
    """
    first, controls, word, first_new, word_new = [], [], [], [], []
    with tempfile.TemporaryDirectory(prefix="playground-") as temporary:
        empty = Path(temporary) / "empty.html"
        empty.write_text(f"<!DOCTYPE html><p {PICTURE}>Hello", encoding="utf-8")
        for _ in range(OPENINGS):
            with _opening(browser, html, REST) as page:
                first.append(page.evaluate(PAINTED))
                page.wait_for_selector("body.ready")
                controls.append(page.evaluate(READY))
            with _opening(browser, empty, REST) as page:
                word.append(page.evaluate(PAINTED))
            with _opening(browser, html) as page:
                first_new.append(page.evaluate(PAINTED))
            with _opening(browser, empty) as page:
                word_new.append(page.evaluate(PAINTED))
    page = opened(browser, html, "desktop", "light")
    frames = page.evaluate(DRAG, [variable, FRAMES])
    page.context.close()
    return {
        "first picture painted after": first,
        "controls answer after": controls,
        "a page of one word after": word,
        "first picture in a window just opened after": first_new,
        "a page of one word in a window just opened after": word_new,
        "work of a frame": frames,
    }


@contextmanager
def _opening(browser: Browser, html: Path, rest: float = 0) -> Iterator[Page]:
    """The file, being loaded in a new window that rested [ms]."""
    width, height = SIZES["desktop"]
    with browser.new_context(viewport={"width": width, "height": height}) as context:
        page = context.new_page()
        page.wait_for_timeout(rest)
        page.goto(html.resolve().as_uri())
        yield page
