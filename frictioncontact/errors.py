"""The errors and the warning that users see, and the words for a wrong name."""

import difflib
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

SHOWN = 40  # characters of a wrong name or value in a message


class UserError(ValueError):
    """A mistake that the user can correct; the text names it in one line."""


class FrictionError(UserError):
    """The FMU refused a call; the text is its message."""


class BatchError(UserError):
    """The batch can't be run, or a scenario was refused; the text gives the reason in one line."""


class FrictionWarning(UserWarning):
    """An accepted scene that is probably a mistake: the FMU's own warning, a setting that the scene does not
    use, or a magnitude that looks like another unit."""


_is_quiet = ContextVar("is_quiet", default=False)


def is_quiet() -> bool:
    return _is_quiet.get()


def warn(texts: Iterable[str]) -> None:
    """Warns of each text, at the line of the user that called the package."""
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("frictioncontact."):
        frame, level = frame.f_back, level + 1
    for text in texts:
        warnings.warn(text, FrictionWarning, stacklevel=level)


@contextmanager
def quiet() -> Iterator[None]:
    """The package calls itself here: whoever called it was warned already."""
    token = _is_quiet.set(True)
    try:
        yield
    finally:
        _is_quiet.reset(token)


def shown(value: object) -> str:
    """Quoted as text, and cut where it is long."""
    text = str(value)
    return repr(text if len(text) <= SHOWN else text[:SHOWN] + "...")


def did_you_mean(name: str, known: Iterable[str], likeness: float = 0.5) -> str:
    """What an error about a wrong name ends with; empty if no known name is like it (likeness of difflib)."""
    names = list(known)
    by_case = [other for other in names if other.lower() == name.lower()]
    ends = [other for other in names if len(name) > 1 and other.lower().endswith("." + name.lower())]
    close = by_case or ends or difflib.get_close_matches(name[:SHOWN], names, 1, likeness)
    return f"; did you mean {close[0]}?" if close else ""


def unknown_variable(name: str, known: Iterable[str]) -> str:
    """The error for a name that is not among the known variables of the FMU."""
    if "," in name:
        return f"{shown(name)} is no variable of the FMU; give one name each, without commas"
    named = name if len(name) <= SHOWN else shown(name)
    return f"{named or 'a variable without a name'} is no variable of the FMU{did_you_mean(name, known)}"


def indefinite(noun: str) -> str:
    """The noun after its article."""
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"
