"""The headless Chromium in which the pages are looked at."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, BrowserContext, Error, Page, sync_playwright

from frictioncontact.errors import UserError

PATIENCE = 300_000.0  # ms, for a page: the machine may have much other work
SIZES = {"desktop": (1440, 900), "phone": (390, 844)}  # of windows, pixels of CSS
NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")


def find_browser() -> str | None:
    return next((path for name in NAMES if (path := shutil.which(name))), None)


@contextmanager
def chromium() -> Iterator[Browser]:
    """UserError where none is installed, or where it does not start."""
    executable = find_browser()
    if executable is None:
        raise UserError("no Chromium is installed; on Debian or Ubuntu: sudo apt-get install chromium")
    with sync_playwright() as playwright:
        launch = partial(playwright.chromium.launch, executable_path=executable, args=["--no-sandbox"])
        try:
            try:
                browser = launch()
            except Error:  # on a machine with much other work the first may be gone before it answers
                browser = launch()
        except Error as error:
            raise UserError(f"Chromium does not start: {error.message.splitlines()[0]}") from None
        yield browser
        browser.close()


def window(browser: Browser, size: str, **options: Any) -> BrowserContext:
    """A window of one of SIZES, with what else playwright's new_context takes."""
    width, height = SIZES[size]
    viewport = {"width": width, "height": height}
    return browser.new_context(viewport=viewport, has_touch=size == "phone", **options)


def watch(page: Page, home: Path, heard: list[str]) -> None:
    """Adds to heard what pages of a file or folder must not do: errors, warnings, requests beyond it.

    They may take PATIENCE.
    """
    own = (home.resolve().as_uri(), "blob:", "data:")

    def hear(wrong: bool, what: str) -> None:
        if wrong:
            heard.append(f"{page.url}: {what}")

    page.set_default_timeout(PATIENCE)
    page.on("pageerror", lambda error: hear(True, f"script error: {error}"))
    page.on("console", lambda said: hear(said.type in ("error", "warning"), f"console: {said.text}"))
    page.on("request", lambda asked: hear(not asked.url.startswith(own), f"request: {asked.url}"))
