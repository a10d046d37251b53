"""Opens the page with the FMU alive in it, or copies it."""

import argparse
import webbrowser
from collections.abc import Sequence

from frictioncontact import resources
from frictioncontact.command import command_line, new_file, say_written, shown
from frictioncontact.files import whole_file

DESCRIPTION = """\
Opens one web page that has the FMU in it, compiled to WebAssembly: sliders for its variables, its force, its
means. The page loads nothing and sends nothing."""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact playground", DESCRIPTION)
    parser.add_argument("--output", type=new_file, metavar="HTML", help="write the page there, open nothing")
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    page = resources.playground()
    if options.output:
        with whole_file(options.output) as unfinished:
            unfinished.write_bytes(page.read_bytes())
        say_written([options.output])
    elif webbrowser.open(page.as_uri()):
        print(f"opened {shown(page)}")
    else:
        print(f"no browser was found: open {shown(page)}")
