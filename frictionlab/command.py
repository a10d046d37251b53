"""What all commands share: options, the one line that an error becomes, progress, shown paths, CSV files."""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from frictionlab.project import ROOT, UserError


def command_line(name: str, description: str, epilog: str | None = None) -> argparse.ArgumentParser:
    """The parser of scripts/NAME; its texts keep their lines."""
    return argparse.ArgumentParser(
        prog=f"scripts/{name}",
        description=description,
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def add_fmu(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--fmu", type=Path, help="use this FMU instead of building one")


def add_output(parser: argparse.ArgumentParser, default: Path) -> None:
    name = default.relative_to(ROOT)
    parser.add_argument("--output", type=Path, default=default, help=f"folder to write to ({name})")


def finish(run: Callable[[argparse.Namespace], None], options: argparse.Namespace) -> None:
    """Runs a command. What its user can mend becomes one line on standard error, and the exit status 1."""
    try:
        run(options)
    except UserError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        where = error.filename or getattr(options, "output", None)
        sys.exit(f"error: {f'{where}: ' if where else ''}{error.strerror or error}")


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """On standard error, gone at the end; nothing where that is no terminal."""
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        yield progress


def shown(path: Path) -> str:
    """The path as a person in the present folder would type it."""
    path = path.resolve()
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)


def say_written(paths: Sequence[Path]) -> None:
    print("Written:", ", ".join(map(shown, paths)))


def write_csv(rows: Sequence[Mapping[str, object]], path: Path) -> Path:
    """The rows under a header with the first one's names."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return path
