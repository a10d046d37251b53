"""Contacts that were measured: `contacts`, as start values with their source, range and uncertainty."""

from __future__ import annotations

import argparse
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from frictioncontact import resources
from frictioncontact.command import command_line
from frictioncontact.errors import UserError, did_you_mean, shown

if TYPE_CHECKING:
    from frictioncontact.values import Value


@dataclass(frozen=True)
class Contact:
    """A measured contact."""

    name: str
    title: str
    start: dict[str, Value] = field(repr=False)  # start values for `simulate`, SI units
    source: str = field(repr=False)
    valid: str = field(repr=False)  # where it was measured
    uncertainty: str = field(repr=False)
    # Of start values, as uncertainty says.
    intervals: dict[str, list[float]] = field(default_factory=dict, repr=False)
    data: Path | None = field(default=None, repr=False)  # the measured rows, a file that `identify` reads

    def __str__(self) -> str:
        values = " ".join(f"--set {name}={value}" for name, value in self.start.items())
        rows = [("start, SI", values), ("valid", self.valid)]
        intervals = [f"{name} {low:g} to {high:g}" for name, (low, high) in self.intervals.items()]
        rows += [("interval, SI", interval) for interval in intervals]
        rows += [("uncertainty", self.uncertainty), ("source", self.source)]
        rows += [("data", str(self.data))] if self.data else []
        return "\n".join([f"{self.name}: {self.title}", *(f"  {name:<14} {text}" for name, text in rows)])


class Contacts(dict[str, Contact]):
    """Measured contacts by name."""

    def __missing__(self, name: object) -> Contact:
        hint = did_you_mean(str(name), self) or ";"
        raise UserError(f"{shown(name)} is no measured contact{hint} these are: {', '.join(self)}")

    def __repr__(self) -> str:
        return "\n".join(f"{name:<16} {contact.title}" for name, contact in self.items())


def contacts() -> Contacts:
    """Those of data/contacts.toml."""
    folder = resources.data()
    table = tomllib.loads((folder / "contacts.toml").read_text(encoding="utf-8"))
    for entry in table.values():
        entry["data"] = folder / entry["data"] if "data" in entry else None
    return Contacts({name: Contact(name, **entry) for name, entry in table.items()})


DESCRIPTION = """\
Contacts that were measured: without a name the list, with one its start values, where they hold, how
uncertain they are, and their source.

  %(prog)s steel-dry"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact contacts", DESCRIPTION)
    parser.add_argument("name", nargs="?", help="of a contact")
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    print(contacts()[options.name] if options.name else contacts())
