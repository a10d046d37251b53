"""FrictionContact.fmu through fmpy: load it once, open sessions, step them, read arrays.

    with FrictionFmu("build/FrictionContact.fmu") as fmu, fmu.session({"vibration.V_1": 1.44}) as session:
        session.step(5e-5)
        session.get("F_t_mean")

A value of an enumeration is its number or its item's name. UserError is raised for a name or a value that is
wrong, FrictionError with the FMU's own message for a call that it refuses.
"""

from __future__ import annotations

import copy
import io
import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from ctypes import c_double, c_int, c_uint, cdll
from functools import cache
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, NoReturn, Self

import fmpy
import numpy as np
from fmpy import extract, fmi2, read_model_description
from fmpy.fmi1 import FMICallException

from . import resources
from .errors import FrictionError, UserError, shown
from .values import Value, Variables, pairs, path_of, real

if TYPE_CHECKING:
    from fmpy.model_description import ModelDescription

MODEL = "FrictionContact"
FMI2_WARNING = 1
INPUTS = ("V", "d", "E", "load", "V_y", "body.F")
OUTPUTS = ("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta")
SETTLED = {"initialState": "Settled"}  # start values: the periodic state
_OPENING = Lock()  # one thread unzips what all threads use


class Closing:
    """What is closed at the end of a `with` block."""

    def close(self) -> None:
        raise NotImplementedError

    def __reduce__(self) -> NoReturn:
        raise UserError(f"a {type(self).__name__} can't be copied or pickled; open another one")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


class Loaded:
    """A library of FMPy without its constructor, which changes the folder of the process while it loads.

    FMPy binds the functions by the first letters of the class's name. A copy is another instance's.
    """

    component = callbacks = fmiCallLogger = None
    instanceName, requireFunctions = "contact", True

    def __init__(self, description: ModelDescription, directory: Path, library: Path) -> None:
        self.guid, self.unzipDirectory = description.guid, str(directory)
        self._functions: dict[str, Any] = {}
        self.dll = cdll.LoadLibrary(str(library))
        self._loadFunctions()  # type: ignore[attr-defined]


class FMU2Contact(Loaded, fmi2.FMU2Slave):
    """In co-simulation."""


class FrictionFmu(Closing):
    """The unzipped FMU and its model description, from which sessions are opened.

    path      the .fmu file, for example `fc.FMU`, or its bytes
    raises    UserError: no such file, or not an FMU of this model

    It is closed at the end of a `with` block, by `close()`, or when nothing uses it any more. Any number of
    threads may open sessions of it.

        with fc.FrictionFmu(fc.FMU) as fmu, fmu.session({"vibration.V_1": 1.44}) as contact:
            contact.set("V", 0.5)
            contact.step(1e-3)
            print(contact.get("F_t_mean"))
    """

    def __init__(self, path: str | Path | bytes) -> None:
        self.path = Path("the file") if isinstance(path, bytes) else path_of(path, "fmu")
        self._content = path if isinstance(path, bytes) else None
        self._temporary = Path(tempfile.mkdtemp(prefix="friction-fmu-"))
        self._removed = weakref.finalize(self, _remove, self._temporary, os.getpid())  # at exit at the latest
        try:
            self._unzip()
        except BaseException:
            self.close()
            raise
        self.known = Variables(self.description)
        self.variables = self.known.all

    def _unzip(self) -> None:
        source, failed = self.path if self._content is None else io.BytesIO(self._content), ""
        try:
            self.directory = Path(extract(source, unzipdir=self._temporary))
            failed = "its modelDescription.xml: "
            self.description = read_model_description(str(self.directory), validate=False)
            failed = "its library: "
            self.library = self._library_here()
            self._loaded = FMU2Contact(self.description, self.directory, self.library)
        except UserError:
            raise
        except Exception as error:  # whatever the readers make of what is none
            if isinstance(error, OSError) and not failed:
                at = "" if error.filename == str(self.path) else f"can't be unpacked into {self._temporary}: "
                raise UserError(f"{self.path}: {at}{error.strerror or error}") from None
            if os.name == "posix" and os.statvfs(self._temporary).f_flag & getattr(os, "ST_NOEXEC", 0):
                raise UserError(
                    f"{self._temporary.parent} does not allow programs to run, and so no FMU: set TMPDIR "
                    "in the environment to a folder that does"
                ) from None
            reason = (str(error) or type(error).__name__).splitlines()[0]
            raise UserError(f"{self.path} is not an FMU: {failed}{reason}") from None

    def _library_here(self) -> Path:
        """Of the platform tuple of FMI 3.0, section 2.5.1.4.1, else of FMI 2.0's name.

        FMPy takes linux64 on ARM too, though FMI 2.0 means x86-64 by it.
        """
        if self.description.modelName != MODEL or self.description.coSimulation is None:
            raise UserError(f"{self.path} is another FMU: {self.description.modelName}")
        name = f"{self.description.coSimulation.modelIdentifier}{fmpy.sharedLibraryExtension}"
        for folder in (fmpy.platform_tuple, fmpy.platform):
            if (path := self.directory / "binaries" / folder / name).is_file():
                return path
        has = ", ".join(sorted(path.name for path in self.directory.glob("binaries/*")))
        raise UserError(f"{self.path}: has no binary for this platform, {fmpy.platform}, only {has}")

    def __reduce__(self) -> tuple[Callable[..., FrictionFmu], tuple[Path | bytes | None]]:
        """Of a copy: the package's own FMU, or the file, opened there."""
        return opened, (self._content or (None if self.path == resources.fmu() else self.path),)

    def session(
        self,
        start_values: Mapping[str, Value] | None = None,
        start: float = 0.0,
        tolerance: float | None = None,
    ) -> Session:
        """An initialized instance.

        start_values  name of an input or parameter -> its value, SI units; of an enumeration an item or its
                      number
        start         time at which it starts, s
        tolerance     solver.tolerance, if the start values have none
        raises        UserError: an unknown name or a wrong value; FrictionError: the FMU refuses them
        """
        if not self.directory.exists():
            raise UserError(f"{self.path}: this FrictionFmu is closed; open another one")
        return Session(self, copy.copy(self._loaded), start_values or {}, real(start, "start"), tolerance)

    def close(self) -> None:
        """Removes the unzipped files."""
        self._removed()


def _remove(folder: Path, process: int) -> None:
    """Of the process that made it: a fork leaves it alone."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)


def logging_callbacks(messages: list[str], warnings: list[str] | None = None) -> fmi2.fmi2CallbackFunctions:
    """Callbacks of an instance, which keep its messages; the caller keeps them while the instance lives."""

    def log(environment: object, instance: bytes, status: int, category: bytes, message: bytes) -> None:
        messages.append(message.decode())
        if warnings is not None and status == FMI2_WARNING:
            warnings.append(message.decode())

    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(log)
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
    return callbacks


class Session(Closing):
    """One instance, stepped by its user. `time` [s] is its present time, `warnings` the FMU's warnings.

    Opened by `FrictionFmu.session`, closed at the end of a `with` block or by `close()`. Every call raises
    UserError for an unknown name or a wrong value, and FrictionError if the FMU refuses it; the instance is
    then as before. One thread at a time may use it.
    """

    def __init__(
        self,
        fmu: FrictionFmu,
        slave: fmi2.FMU2Slave,
        start_values: Mapping[str, Value],
        start: float,
        tolerance: float | None,
    ) -> None:
        self.fmu = fmu
        self.slave = slave
        self.time = start
        self.messages: list[str] = []
        self.warnings: list[str] = []
        self._in_use = Lock()
        self._callbacks = logging_callbacks(self.messages, self.warnings)
        slave.instantiate(callbacks=self._callbacks, loggingOn=True)
        try:
            tolerance = None if tolerance is None else real(tolerance, "tolerance")
            self._call(slave.setupExperiment, tolerance, start)
            for name, value in pairs(start_values, "start_values").items():
                self.set(name, value)
            self._call(slave.enterInitializationMode)
            self._call(slave.exitInitializationMode)
        except UserError:
            self.close()
            raise

    def __repr__(self) -> str:
        state = "closed" if self.slave.component is None else f"at {self.time:g} s"
        return f"<session of {self.fmu.path.name}, {state}>"

    def _call(self, function: Callable[..., Any], *arguments: object) -> Any:
        if not self._in_use.acquire(blocking=False):
            raise UserError("another thread uses this session; open one for each thread")
        try:
            if self.slave.component is None:
                raise UserError("this session is closed; open another one")
            before = len(self.messages)
            return function(*arguments)
        except FMICallException as error:
            raise FrictionError("; ".join(self.messages[before:]) or str(error)) from None
        finally:
            self._in_use.release()

    def set(self, name: str, value: Value) -> None:
        """Sets an input or a parameter, SI units; of an enumeration an item or its number."""
        variable = self.fmu.variables.get(name) if isinstance(name, str) else None
        if variable is None or type(value) is not float or variable.type != "Real":
            code = self.fmu.known.number(name, value, f"set {name}")
        else:
            code = value  # checked by the FMU
        is_real = self.fmu.variables[name].type == "Real"
        setter = self.slave.setReal if is_real else self.slave.setInteger
        self._call(setter, [self.fmu.variables[name].valueReference], [code if is_real else int(code)])

    def set_rates(self, **rates: float) -> None:
        """Time derivatives [SI units per s] of inputs over the next step."""
        references = [self.fmu.known.find(name, "set_rates", ("input",)).valueReference for name in rates]
        values = [real(rate, name) for name, rate in rates.items()]
        self._call(self.slave.setRealInputDerivatives, references, [1] * len(rates), values)

    def step(self, h: float) -> None:
        """Advances by h [s], with the inputs held or moving at the rates that were set."""
        self._call(self._advance, real(h, "h"))

    def _advance(self, h: float) -> None:
        self.slave.doStep(self.time, h)
        self.time += h

    def get(self, name: str) -> float:
        """The value of any variable of type Real now, SI units."""
        return float(self._read([name], "get")[0])

    def read(self, names: Sequence[str] = OUTPUTS) -> np.ndarray:
        """The values of several variables now, an array of their number."""
        if isinstance(names, str) or not isinstance(names, Iterable):
            raise UserError(f"read: {shown(names)} is not a sequence of names")
        return self._read(names, "read")

    def _read(self, names: Iterable[str], where: str) -> np.ndarray:
        references = [self.fmu.known.readable(name, where).valueReference for name in names]
        return np.array(self._call(self.slave.getReal, references))

    def force_rate(self, output: str = "F_t") -> float:
        """The time derivative [N/s] of F_t or F_y at the present time."""
        order, value = (c_int * 1)(1), (c_double * 1)()
        reference = (c_uint * 1)(self.fmu.known.find(output, "force_rate", ("output",)).valueReference)
        self._call(self.slave.fmi2GetRealOutputDerivatives, self.slave.component, reference, 1, order, value)
        return value[0]

    def slope(self, output: str, name: str) -> float:
        """Partial derivative of an output by an input now, SI units."""
        of, by = ([self.fmu.known.readable(each, "slope").valueReference] for each in (output, name))
        return self._call(self.slave.getDirectionalDerivative, of, by, [1.0])[0]

    def save(self) -> tuple[float, bytes]:
        """The whole state, to go on from again with `restore`: the time [s], and what the FMU keeps."""
        state = self._call(self.slave.getFMUstate)
        try:
            return self.time, self._call(self.slave.serializeFMUstate, state)
        finally:
            self.slave.freeFMUstate(state)

    def restore(self, saved: tuple[float, bytes]) -> None:
        """Goes back to a state that `save` gave, here or in another session of this FMU."""
        if not isinstance(saved, tuple) or [type(part) for part in saved] != [float, bytes]:
            raise UserError(f"restore: {shown(saved)} is not a state that save() gave")
        time, kept = saved
        state = self._call(self.slave.deSerializeFMUstate, kept)
        try:
            self._call(self.slave.setFMUstate, state)
        finally:
            self.slave.freeFMUstate(state)
        self.time = time

    def close(self) -> None:
        """Frees the instance, once a call of another thread has ended."""
        with self._in_use:
            if self.slave.component is not None:
                self.slave.fmi2FreeInstance(self.slave.component)
                self.slave.component = None


def simulate(
    fmu: FrictionFmu,
    start_values: Mapping[str, Value],
    step: float,
    count: int,
    inputs: Mapping[str, Sequence[float]] | None = None,
    linear: bool = False,
    start: float = 0.0,
    outputs: Sequence[str] = OUTPUTS,
) -> dict[str, np.ndarray]:
    """count steps of the length step [s]; arrays of count + 1 points, "time" among them.

    inputs: count + 1 samples of any of INPUTS at the communication points; held over each step, or linear
    between them. Before the first step F_t_mean equals what the FMU gives at the start.
    """
    samples = {name: np.asarray(values, dtype=float) for name, values in (inputs or {}).items()}
    held = {name: values[:count] for name, values in samples.items()}
    rates = {name: np.diff(values) / step for name, values in samples.items()} if linear else {}
    rows = run(fmu, start_values, np.full(count, step), held, rates, start, outputs)
    return {"time": start + step * np.arange(count + 1), **dict(zip(outputs, rows.T, strict=True))}


def run(
    fmu: FrictionFmu,
    start_values: Mapping[str, Value],
    steps: np.ndarray,
    inputs: Mapping[str, np.ndarray],
    rates: Mapping[str, np.ndarray],
    start: float = 0.0,
    outputs: Sequence[str] = OUTPUTS,
    warnings: list[str] | None = None,
) -> np.ndarray:
    """Outputs at the start and after each of the steps [s], [point, output].

    inputs and rates: value at the begin of each step, and its time derivative over the step (none: held).
    warnings: gets what the FMU warned of.
    """
    rows = np.empty((len(steps) + 1, len(outputs)))
    first = {name: float(values[0]) for name, values in inputs.items()}
    with fmu.session({**start_values, **first}, start) as session:
        rows[0] = session.read(outputs)
        for k, step in enumerate(steps):
            for name, values in inputs.items():
                session.set(name, float(values[k]))
            if rates:
                session.set_rates(**{name: values[k] for name, values in rates.items()})
            session.step(float(step))
            rows[k + 1] = session.read(outputs)
        if warnings is not None:
            warnings += session.warnings
    return rows


def opened(file: str | Path | bytes | None) -> FrictionFmu:
    """The FMU of a file or of its bytes, or the package's own; unzipped once in a process while it stays."""
    version: tuple[int, ...] = ()
    if not isinstance(file, bytes):
        file = resources.fmu() if file is None else path_of(file, "fmu")
        try:
            stat = file.stat()
        except OSError as error:
            raise UserError(f"{file}: {error.strerror}") from None
        if file.is_dir():
            raise UserError(f"{file}: Is a directory")
        version = (stat.st_ino, stat.st_mtime_ns, stat.st_size)
    with _OPENING:
        return _opened(file, version)


@cache
def _opened(file: Path | bytes, version: tuple[int, ...]) -> FrictionFmu:
    return FrictionFmu(file)
