"""What all commands share: options, the one line that an error becomes, progress, shown paths, CSV files."""

from __future__ import annotations

import argparse
import csv
import importlib.util
import os
import re
import sys
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from frictioncontact import resources
from frictioncontact.errors import FrictionWarning, UserError
from frictioncontact.files import reason, whole_file

if TYPE_CHECKING:
    import pandas as pd

    from frictioncontact.values import Variables

PAUSE = 10.0  # s
TABLE = 120  # characters, of the widest table
called_as: str | None = None  # what a file of scripts/ calls the command of its user


class Parser(argparse.ArgumentParser):
    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self._negative_number_matcher = re.compile(r"-\.?\d")  # -1e-4 too is a value, and not an option

    def error(self, message: str) -> NoReturn:
        """One line, with the grammar of values."""
        words = message.partition("unrecognized arguments: ")[2].split()
        if words and "=" in words[0] and "--set" in self.format_usage():
            message += f"; write --set {words[0].lstrip('-')}"
        self.exit(2, f"{self.prog}: error: {message}; see {self.prog} --help\n")


def command_line(prog: str, description: str, epilog: str | None = None) -> argparse.ArgumentParser:
    """The parser of a command; its texts keep their lines, and %(prog)s in them is what it is called."""
    return Parser(
        prog=called_as or prog,
        description=description,
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def add_fmu(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--fmu", type=Path, help="use this FMU instead of the package's own")


def add_set(parser: argparse.ArgumentParser, of: str) -> None:
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE",
        help=f"start value {of}, in SI units; of an enumeration an item or its number; again for each",
    )  # fmt: skip


def add_column(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--column", action="append", default=[], metavar="NAME=HEADING",
        help="heading in the file of what the FMU calls NAME, or 'NAME [UNIT]'; again for each",
    )  # fmt: skip


def add_output(parser: argparse.ArgumentParser, default: Path) -> None:
    parser.add_argument(
        "--output", type=Path, default=default, help=f"folder to write to, made if missing ({place(default)})"
    )


def new_file(text: str) -> Path:
    """The path of a file to write, of an option; its folder must be there."""
    path = Path(text)
    if not path.parent.is_dir():
        raise argparse.ArgumentTypeError(f"there is no folder {path.parent}")
    return path


def place(path: Path) -> str:
    """A default path in a help text: within the clone, or within the present folder."""
    return str(path.relative_to(resources.CLONE) if path.is_absolute() else path).replace("%", "%%")


def finish(run: Callable[[argparse.Namespace], None], options: argparse.Namespace) -> None:
    """Runs a command. What its user can mend becomes one line on standard error, and the exit status 1."""
    warnings.simplefilter("always", FrictionWarning)
    warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
    try:
        run(options)
        sys.stdout.flush()
    except UserError as error:
        sys.exit(f"error: {error}")
    except BrokenPipeError:  # who reads has seen enough, as `| head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(1)
    except OSError as error:
        where = error.filename or ("standard output" if _stdout_fails() else getattr(options, "output", None))
        sys.exit(f"error: {f'{where}: ' if where else ''}{reason(error)}")


def main(command: ModuleType, argv: Sequence[str] | None = None) -> None:
    """Runs a command, a module with arguments() and run(), with these words or those of the command line."""
    finish(command.run, command.arguments(argv))


def main_of(command: ModuleType) -> Callable[[], None]:
    """What runs a command: its own main(), or the one of all."""
    return getattr(command, "main", partial(main, command))


def _stdout_fails() -> bool:
    """Whether nothing can be printed any more. What was not yet written then goes nowhere."""
    try:
        os.write(1, b"\n")
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return True
    return False


def can_draw() -> bool:
    """Whether matplotlib is there; where it is not, says on standard error how to get it."""
    if importlib.util.find_spec("matplotlib"):
        return True
    print("no pictures: pip install 'frictioncontact[plot]' installs what draws them", file=sys.stderr)
    return False


def table_console() -> Console:
    """Standard output, for tables: wide enough to cut none off, whatever the terminal says of its width."""
    return Console(width=max(TABLE, Console().width))


def as_table(
    headings: Sequence[str], rows: Iterable[Sequence[str]], title: str | None = None, names: int = 1
) -> Table:
    """A table of numbers, as texts; the first columns, as many as names says, hold words."""
    table = Table(title=title and escape(title), title_justify="left")
    for k, heading in enumerate(headings):
        table.add_column(escape(heading), justify="left" if k < names else "right", no_wrap=k < names)
    for row in rows:
        table.add_row(*row)
    return table


def print_frame(frame: pd.DataFrame, known: Variables, scene: Mapping[str, Any], **units: str) -> None:
    """A table for people: units in its headings, and 0 for rounding, below 1e-12 of its column.

    Below 1e-12 of the largest force or F_C for a force. units: of columns that are no variables.
    """
    units = {name: variable.unit for name, variable in known.all.items()} | {"time": "s"} | units
    scale, forces = frame.abs().max(), [name for name in frame if units[name] == "N"]
    limit = 0.0 if scene.get("friction.limit") == "Load" else scene.get("F_C", known.all["F_C"].start)
    scale[forces] = max(float(limit), scale[forces].max())
    rounded = frame.mask(frame.abs() < 1e-12 * scale, 0.0)
    rounded.columns = [f"{name} [{units[name]}]" for name in frame]
    print(rounded.to_string(index=False, float_format="{:.6g}".format))


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """On standard error, gone at the end; nothing where that is no terminal."""
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        yield progress


def teller(bar: Progress) -> Callable[[str], None]:
    """Shows a text as what is begun; where there is no terminal a line every PAUSE seconds."""
    task, told = bar.add_task("", total=None), time.monotonic()

    def tell(text: str) -> None:
        nonlocal told
        bar.update(task, description=text)
        if not bar.console.is_terminal and time.monotonic() - told > PAUSE:
            print(text, file=sys.stderr, flush=True)
            told = time.monotonic()

    return tell


def shown(path: Path) -> str:
    """The path as a person in the present folder would type it."""
    path = path.resolve()
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)


def say_written(paths: Sequence[Path]) -> None:
    if paths:
        print("Written:", ", ".join(map(shown, paths)))


def write_csv(rows: Sequence[Mapping[str, object]], path: Path) -> Path:
    """The rows under a header with the first one's names."""
    with whole_file(path) as unfinished, unfinished.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return path
