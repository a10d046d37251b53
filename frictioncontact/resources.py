"""Where the package finds what it brings: the FMU, the batch host, the measurements, the playground's page.

An installed wheel holds them in its own folder `bundled`. In a clone, whose installation is editable, there
is no such folder: what is built is in build/ of the project, and the measurements are in data/.
"""

import sys
from pathlib import Path

from .errors import UserError

BUNDLED = Path(__file__).resolve().parent / "bundled"
CLONE = BUNDLED.parents[1]
LIBRARY_SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")


def fmu() -> Path:
    """FrictionContact.fmu."""
    return _found("FrictionContact.fmu", "build", "scripts/run")


def batch_host() -> Path:
    """The shared library of host/batch.c for this platform."""
    return _found(f"friction_batch{LIBRARY_SUFFIX}", "build", "scripts/run")


def playground() -> Path:
    """The web page with the FMU in it."""
    return _found("playground.html", "build", "scripts/playground")


def data() -> Path:
    """The folder of the measurements."""
    return BUNDLED / "data" if BUNDLED.is_dir() else CLONE / "data"


def output(folder: str = "") -> Path:
    """Where commands write unless told otherwise: build/ of a clone, or the present folder."""
    return (Path() if BUNDLED.is_dir() else CLONE / "build") / folder


def _found(name: str, folder: str, maker: str) -> Path:
    """UserError where the file is missing, with what makes it."""
    if BUNDLED.is_dir():
        path, remedy = BUNDLED / name, "install the package anew"
    else:
        path, remedy = CLONE / folder / name, f"{maker} makes it"
    if not path.is_file():
        raise UserError(f"{path} is missing: {remedy}")
    return path
