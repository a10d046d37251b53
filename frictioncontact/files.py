"""Files that appear whole or not at all."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Gives a path beside it to write to, which takes its place at the end; nothing is left if that fails.

    A device or a pipe is written to itself.
    """
    if path.is_dir():
        raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.exists() and not path.is_file():  # a device or a pipe, which must not be replaced
        yield path
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield unfinished
        unfinished.replace(path)
    except OSError as error:
        if str(error.filename) == str(unfinished):  # the user knows nothing of this one
            error.filename = str(path)
        raise
    finally:
        with suppress(OSError):
            unfinished.unlink()


def reason(error: OSError) -> str:
    """Why a path can't be used."""
    is_file = isinstance(error, FileExistsError)
    return "is a file, and not a folder" if is_file else error.strerror or str(error)


def write_whole(path: Path, text: str) -> None:
    """Writes a text in UTF-8."""
    with whole_file(path) as unfinished:
        unfinished.write_text(text, encoding="utf-8")
