"""Builds the web site from the Markdown pages, the docstrings and the playground. Open index.html of the
folder in a browser; search works there too."""

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from sphinx.cmd.build import build_main

from frictioncontact.command import add_output, command_line, shown
from frictioncontact.errors import UserError
from frictioncontact.files import write_whole
from tools.playground.page import page_text
from tools.project import ROOT
from tools.site.check import problems

HERE = Path(__file__).resolve().parent


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/site", __doc__)
    add_output(parser, ROOT / "build" / "site")
    parser.add_argument(
        "--older", type=Path, nargs="*", default=[], metavar="FOLDER", help="sites of older versions, by name"
    )
    parser.add_argument("--check", action="store_true", help="follow all links, and open it in Chromium")
    return parser.parse_args(argv)


def build(output: Path, older: Sequence[Path] = ()) -> None:
    """The site into the folder, in place of the one that was there; UserError if Sphinx finds anything."""
    if output.exists() and not (output / "searchindex.js").exists() and any(output.iterdir()):
        raise UserError(f"{shown(output)} holds something that is no site: give another folder")
    playground = page_text()
    # the page of wrong calls, from the tests' own calls
    subprocess.run([sys.executable, "tests/fmi2/bad_input_page.py"], cwd=ROOT, check=True)
    shutil.rmtree(output, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix="site-") as doctrees:
        names = " ".join(folder.name for folder in older)
        options = ["-q", "-W", "--keep-going", "-c", HERE, "-d", doctrees, "-D", f"older={names}"]
        if build_main([str(word) for word in (*options, ROOT, output)]):
            raise UserError("the site has faults: see above")
    write_whole(output / "playground.html", playground)
    for folder in older:
        shutil.copytree(folder, output / folder.name)


def run(options: argparse.Namespace) -> None:
    build(options.output, options.older)
    print(f"{shown(options.output / 'index.html')}: open it in a browser")
    if options.check:
        found = problems(options.output)
        if found:
            raise UserError("\n".join(found))
        print("all links lead somewhere; no page asks for anything outside or has an error")
