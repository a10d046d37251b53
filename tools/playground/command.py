"""Make one self-contained HTML file with the FMU, compiled to WebAssembly, in it."""

import argparse
from collections.abc import Sequence
from itertools import product
from pathlib import Path

from playwright.sync_api import Browser

from frictioncontact.command import command_line, shown
from frictioncontact.files import write_whole
from tools.browser import SIZES, chromium, window
from tools.playground.page import page_text
from tools.project import ROOT

DEFAULT = ROOT / "build" / "playground.html"
SCHEMES = ("light", "dark")


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/playground", __doc__)
    default = "default: build/playground.html"
    parser.add_argument("-o", "--output", type=Path, default=DEFAULT, metavar="HTML", help=default)
    what = "open it in Chromium and write four pictures of it"
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help=what)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    text = page_text()
    write_whole(options.output, text)
    print(f"{shown(options.output)}, {len(text.encode()) / 1e3:.0f} kB: open it in a browser")
    if options.pictures:
        with chromium() as browser:
            for path in take_pictures(browser, options.output, options.pictures):
                print(shown(path))


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
