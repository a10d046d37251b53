"""One HTML file with the FMU alive in it: `scripts/playground`."""

import argparse
import sys
from itertools import product
from pathlib import Path

from playwright.sync_api import Browser

from frictioncontact.command import shown
from frictioncontact.errors import UserError
from frictioncontact.files import write_whole
from workshop.browser import SIZES, chromium, window
from workshop.playground.page import page_text
from workshop.project import ROOT

DEFAULT = ROOT / "build" / "playground.html"
SCHEMES = ("light", "dark")


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="scripts/playground",
        description="Make one self-contained HTML file with the FMU, compiled to WebAssembly, in it.",
    )
    parser.add_argument(
        "-o", "--output", type=Path, default=DEFAULT, metavar="HTML", help="default: build/playground.html"
    )
    parser.add_argument(
        "--pictures", type=Path, metavar="FOLDER", help="open it in Chromium and write four pictures of it"
    )
    options = parser.parse_args()
    try:
        text = page_text()
        write_whole(options.output, text)
        print(f"{shown(options.output)}, {len(text.encode()) / 1e3:.0f} kB: open it in a browser")
        if options.pictures:
            with chromium() as browser:
                for path in take_pictures(browser, options.output, options.pictures):
                    print(shown(path))
    except UserError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        sys.exit(f"error: {options.output} can't be written: {error.strerror}")


def take_pictures(browser: Browser, html: Path, folder: Path) -> list[Path]:
    """playground-SIZE-SCHEME.png of the first window of the page, all its figures drawn."""
    paths = []
    for size, scheme in product(SIZES, SCHEMES):
        scale = 2 if size == "phone" else 1
        context = window(browser, size, color_scheme=scheme, device_scale_factor=scale)
        page = context.new_page()
        page.goto(html.resolve().as_uri())
        page.wait_for_selector("body.ready[data-worker=done]")
        paths.append(folder / f"playground-{size}-{scheme}.png")
        page.screenshot(path=paths[-1])
        context.close()
    return paths
