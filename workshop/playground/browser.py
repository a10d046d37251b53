"""The page in a headless Chromium, for pictures of it."""

from pathlib import Path

from playwright.sync_api import Browser, Page

from workshop.browser import SIZES, window

SCHEMES = ("light", "dark")


def opened(browser: Browser, html: Path, size: str, scheme: str) -> Page:
    """The page with all its figures drawn."""
    scale = 2 if size == "phone" else 1
    context = window(browser, size, color_scheme=scheme, device_scale_factor=scale)
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
