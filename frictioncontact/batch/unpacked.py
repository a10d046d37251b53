"""An FMU file made ready for the batch runner: its model description, and its library for this platform."""

import ctypes
import hashlib
import io
import zipfile
import zlib
from dataclasses import dataclass, field
from pathlib import Path

import fmpy
from fmpy.model_description import ModelDescription, read_model_description

from ..errors import BatchError
from ..platforms import library_in
from ..values import Variables
from .runner import load_fmu


@dataclass(frozen=True)
class LoadedFmu:
    """Stays loaded as long as the process lives; nothing of it stays in the file system."""

    runner: ctypes.CDLL
    handle: int
    guid: bytes
    variables: Variables = field(repr=False)


_loaded: dict[tuple[object, ...], LoadedFmu] = {}


def loaded_fmu(fmu: str | Path | bytes, runner: ctypes.CDLL) -> LoadedFmu:
    """The FMU of a path or of its file's bytes; unpacked once in a process."""
    if isinstance(fmu, bytes):
        key: tuple[object, ...] = (hashlib.sha256(fmu).digest(),)
        name = "the FMU"
    else:
        name = str(fmu)
        try:
            stat = Path(fmu).stat()
            key = (stat.st_dev, stat.st_ino, stat.st_mtime_ns, stat.st_size)
            fmu = b"" if key in _loaded else Path(fmu).read_bytes()
        except OSError as error:
            raise BatchError(f"{name}: {error.strerror}") from None
        except (TypeError, ValueError):  # a null character
            raise BatchError(f"{name!r}: is no path") from None
    if key not in _loaded:
        _loaded[key] = _load(fmu, name, runner)
    return _loaded[key]


def _load(content: bytes, name: str, runner: ctypes.CDLL) -> LoadedFmu:
    description, library = description_and_library(content, name)
    handle = load_fmu(runner, description.coSimulation.modelIdentifier, library)
    return LoadedFmu(runner, handle, description.guid.encode(), Variables(description))


def description_and_library(content: bytes, name: str) -> tuple[ModelDescription, bytes]:
    """Model description and shared library for this platform of an FMU file; its name is for messages."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = archive.namelist()
            if "modelDescription.xml" not in members:
                raise BatchError(f"{name}: is no FMU: it has no modelDescription.xml")
            try:
                description = read_model_description(io.BytesIO(content), validate=False)
            except Exception as error:  # whatever the reader makes of the text
                reason = str(error).splitlines()[0] if str(error) else type(error).__name__
                raise BatchError(f"{name}: its modelDescription.xml can't be read: {reason}") from None
            if description.fmiVersion != "2.0" or description.coSimulation is None:
                raise BatchError(f"{name}: is not an FMU for co-simulation of FMI 2.0")
            identifier = description.coSimulation.modelIdentifier
            library = library_in(members, identifier)
            if library is None:
                has = sorted(
                    {m.split("/")[1] for m in members if m.startswith("binaries/") and m.count("/") > 1}
                )
                raise BatchError(
                    f"{name}: has no binary for this platform, {fmpy.platform}, only {', '.join(has)}"
                )
            return description, archive.read(library)
    except (zipfile.BadZipFile, zipfile.LargeZipFile, zlib.error, EOFError, OSError, RuntimeError) as error:
        raise BatchError(f"{name}: is no FMU: {str(error) or 'damaged'}") from None
