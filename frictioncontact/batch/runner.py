"""The batch runner of host/batch.h through ctypes: loaded once, its structures declared."""

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from functools import cache
from pathlib import Path

from ..errors import BatchError

TEXT = 512  # FMI2_TEXT
STATISTICS = ("end", "change", "mean", "min", "max", "samples")  # BatchStatistic
NOT_RUN, DONE, REFUSED = range(3)  # BatchStatus
DOUBLES = c_void_p  # the address of an array, which the caller keeps


class Column(ctypes.Structure):
    _fields_ = (("value", DOUBLES), ("stride", c_size_t))


class Start(ctypes.Structure):
    _fields_ = (("reference", c_uint), ("is_integer", c_int), ("column", Column))


class Result(ctypes.Structure):
    _fields_ = (("variable", c_int), ("statistic", c_int), ("value", DOUBLES))


class Plan(ctypes.Structure):
    _fields_ = (
        ("guid", c_char_p), ("resources", c_char_p), ("scenarios", c_size_t),
        ("starts", c_size_t), ("start", POINTER(Start)),
        ("variables", c_size_t), ("variable", POINTER(c_uint)),
        ("results", c_size_t), ("result", POINTER(Result)),
        ("frequency", POINTER(c_uint)), ("begin", c_double),
        ("settle", Column), ("duration", Column), ("samples", c_size_t),
        ("inputs", c_size_t), ("input", POINTER(c_uint)), ("moves", DOUBLES), ("rates", DOUBLES),
        ("step", DOUBLES), ("stops_at_refusal", c_int),
    )  # fmt: skip


SIGNATURES = {
    "batch_plan_size": (c_size_t, ()),
    "batch_load": (c_void_p, (c_char_p, c_char_p, c_size_t)),
    "batch_begin": (c_void_p, (c_void_p, POINTER(Plan))),
    "batch_work": (c_int, (c_void_p, c_char_p, c_size_t)),
    "batch_stop": (None, (c_void_p,)),
    "batch_finished": (c_size_t, (c_void_p,)),
    "batch_refusals": (c_size_t, (c_void_p,)),
    "batch_statuses": (POINTER(ctypes.c_ubyte), (c_void_p,)),
    "batch_reason": (c_char_p, (c_void_p, c_size_t)),
    "batch_end": (None, (c_void_p,)),
}


@cache
def runner(path: Path) -> ctypes.CDLL:
    """The runner's functions. BatchError where the library can't be loaded or is of another version."""
    try:
        library = ctypes.CDLL(str(path))
        for name, (result, arguments) in SIGNATURES.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        raise BatchError(f"the batch runner {path} can't be loaded: {str(error).splitlines()[0]}") from None
    if library.batch_plan_size() != ctypes.sizeof(Plan):
        raise BatchError(f"the batch runner {path} is of another version: build the project anew")
    return library


@cache
def loaded(library: ctypes.CDLL, fmu: Path) -> int:
    """Handle of an FMU's shared library for batch_begin. It stays loaded as long as the process lives."""
    why = ctypes.create_string_buffer(TEXT)
    handle: int = library.batch_load(str(fmu).encode(), why, TEXT)
    if not handle:
        raise BatchError(f"the FMU's library can't be loaded: {why.value.decode(errors='replace')}")
    return handle
