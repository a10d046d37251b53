"""The page in a headless Chromium: its pictures, and how long a first picture and a frame take."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, Page

SIZES = {"desktop": (1440, 900), "phone": (390, 844)}  # pixels of CSS
SCHEMES = ("light", "dark")
FRAMES = 120  # that are timed
OPENINGS = 9  # of the page, as well

PICTURE = 'elementtiming="first picture"'  # in page.html: a number that is written with the first figures
PAINTED = """() => new Promise((resolve) => {
    new PerformanceObserver((list) => {
        const picture = list.getEntries().find(({ identifier }) => identifier === "first picture");
        if (picture) resolve(picture.renderTime);
    }).observe({ type: "element", buffered: true });
})"""

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


@dataclass(frozen=True)
class Times:
    """Times in ms: until the first picture, and until a file of one word, is painted; one frame's work."""

    first_pictures: list[float]
    empty_pages: list[float]
    frames: list[float]


def measure(browser: Browser, html: Path, variable: str = "vibration.V_1") -> Times:
    """Frames while a slider is dragged. The files are opened in turns, each in a profile without a cache."""
    with tempfile.TemporaryDirectory(prefix="playground-") as temporary:
        empty = Path(temporary) / "empty.html"
        empty.write_text(f"<!DOCTYPE html><p {PICTURE}>Hello", encoding="utf-8")
        times = [[_painted(browser, file) for file in (html, empty)] for _ in range(OPENINGS)]
    page = opened(browser, html, "desktop", "light")
    frames = page.evaluate(DRAG, [variable, FRAMES])
    page.context.close()
    pictures, empties = zip(*times, strict=True)
    return Times(list(pictures), list(empties), frames)


def _painted(browser: Browser, html: Path) -> float:
    """Time [ms] from the start of the navigation until what is marked as PICTURE is on the screen."""
    width, height = SIZES["desktop"]
    page = browser.new_context(viewport={"width": width, "height": height}).new_page()
    page.goto(html.resolve().as_uri())
    time: float = page.evaluate(PAINTED)
    page.context.close()
    return time
