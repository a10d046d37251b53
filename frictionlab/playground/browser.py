"""The page in a headless Chromium: its pictures, and how long a first picture and a frame take."""

from __future__ import annotations

import statistics
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, Page

SIZES = {"desktop": (1440, 900), "phone": (390, 844)}  # pixels of CSS
SCHEMES = ("light", "dark")
FRAMES = 120  # that are timed

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
    """Times in ms: from opening the file to the first picture; one frame's work while a slider is dragged."""

    first_picture: float
    median_frame: float
    slowest_frame: float


def measure(browser: Browser, html: Path, variable: str = "vibration.V_1") -> Times:
    page = opened(browser, html, "desktop", "light")
    first = page.evaluate("performance.getEntriesByName('first picture')[0].startTime")
    frames = page.evaluate(DRAG, [variable, FRAMES])
    page.context.close()
    return Times(first, statistics.median(frames), max(frames))
