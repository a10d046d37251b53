"""The one error that every command turns into its one line, and the words for a wrong name."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

SHOWN = 40  # characters of a wrong name or value in a message


class UserError(Exception):
    """Something the user can mend; the text names it in one line."""


def unknown_variable(name: str, known: Iterable[str]) -> str:
    """What is said of a name that is none of the known variables of the FMU."""
    names = list(known)
    by_case = [other for other in names if other.lower() == name.lower()]
    close = by_case or difflib.get_close_matches(name[:SHOWN], names, 1, 0.5)
    hint = f"; did you mean {close[0]}?" if close else ""
    named = name if len(name) <= SHOWN else repr(name[:SHOWN] + "...")
    return f"{named or 'a variable without a name'} is no variable of the FMU{hint}"


def indefinite(noun: str) -> str:
    """The noun after its article."""
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"
