"""`contacts`: contacts that were measured, as start values with their source, range and uncertainty."""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from frictioncontact import resources
from frictioncontact.errors import UserError, did_you_mean, shown
from frictioncontact.fmu import opened
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
    intervals: dict[str, list[float]] = field(
        default_factory=dict, repr=False
    )  # of start values, as uncertainty says
    data: Path | None = field(default=None, repr=False)  # the measured rows, a file that `identify` reads

    def __str__(self) -> str:
        units = {name: variable.unit for name, variable in opened(None).variables.items()}
        values = " ".join(f"--set {name}={value}" for name, value in self.start.items())
        rows = [("start, SI", values), ("valid", self.valid)]
        rows += [(name, f"{low:g} to {high:g} {units[name]}") for name, (low, high) in self.intervals.items()]
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
