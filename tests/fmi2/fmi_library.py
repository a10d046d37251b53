"""The shared library as a host sees it: the raw FMI 2.0 functions, no tool between them and a test."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Collection, Mapping, Sequence
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi2 import fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi2 import fmi2EventInfo as EventInfo

from tools import description

STATES, INDICATORS = 4, 4
OK, WARNING, DISCARD, ERROR, FATAL, PENDING = range(6)
MODEL_EXCHANGE, CO_SIMULATION = range(2)
DO_STEP_STATUS, PENDING_STATUS, LAST_SUCCESSFUL_TIME, TERMINATED_STATUS = range(4)


def _type(argument: str) -> Any:
    """Of an argument as the standard's header declares it."""
    if "fmi2Byte" in argument:
        return c_char_p
    name = re.search(r"fmi2\w+|size_t", argument)[0]
    value = {"size_t": c_size_t, "fmi2Status": c_int}.get(name) or getattr(fmpy.fmi2, name)
    return POINTER(value) if re.search(r"[*[]", argument) else value


HEADER = (Path(fmpy.__file__).parent / "c-code" / "fmi2FunctionTypes.h").read_text()
# The arguments of each function of an instance, besides the instance.
SIGNATURES = {
    name: [_type(argument) for argument in arguments.split(",")[1:]]
    for name, arguments in re.findall(r"typedef fmi2Status\s+(\w+)TYPE\s*\(([^)]*)\);", HEADER)
}


@dataclass(frozen=True)
class LogMessage:
    name: str
    status: int
    category: str
    text: str


class Library:
    """One loaded FMU, from the folder it was unpacked to."""

    def __init__(self, folder: Path) -> None:
        model = description.read(folder)
        self.guid: str = model.guid
        self.log_categories = [category.name for category in model.logCategories]
        self.variables = {variable.name: variable for variable in model.modelVariables}
        self.dll = ctypes.CDLL(str(folder / "binaries" / "linux64" / "FrictionContact.so"))
        for name, arguments in SIGNATURES.items():
            getattr(self.dll, name).argtypes = [c_void_p, *arguments]
        text = c_char_p
        self.dll.fmi2Instantiate.argtypes = [
            text,
            c_int,
            text,
            text,
            POINTER(fmi2CallbackFunctions),
            c_int,
            c_int,
        ]
        self.dll.fmi2Instantiate.restype = c_void_p
        self.dll.fmi2FreeInstance.argtypes = [c_void_p]
        self.dll.fmi2FreeInstance.restype = None
        self.dll.fmi2GetVersion.restype = c_char_p
        self.dll.fmi2GetTypesPlatform.restype = c_char_p


class Instance:
    """An instance and the messages it has logged. Methods return the status; fmi2Error raises nothing."""

    def __init__(
        self,
        library: Library,
        name: str | None = "contact",
        guid: str | None = None,
        kind: int = CO_SIMULATION,
        resource_location: str | None = None,
        logging_on: bool = False,
        with_logger: bool = True,
    ) -> None:
        self.library = library
        self.kind = kind
        self.messages: list[LogMessage] = []
        self._logger = fmi2CallbackLoggerTYPE(*[self._log] * with_logger)
        self._callbacks = fmi2CallbackFunctions(logger=self._logger)
        self.component = library.dll.fmi2Instantiate(
            None if name is None else name.encode(),
            kind,
            (library.guid if guid is None else guid).encode(),
            None if resource_location is None else resource_location.encode(),
            byref(self._callbacks),
            0,
            int(logging_on),
        )

    def _log(self, _environment: int, name: bytes, status: int, category: bytes, text: bytes) -> None:
        self.messages.append(LogMessage(name.decode(), status, category.decode(), text.decode()))

    def __enter__(self) -> Instance:
        return self

    def __exit__(self, *_: object) -> None:
        self.free()

    def free(self) -> None:
        if self.component:
            self.library.dll.fmi2FreeInstance(self.component)
            self.component = None

    def call(self, function: str, *arguments: Any) -> int:
        return getattr(self.library.dll, function)(self.component, *arguments)

    # life cycle

    def set_up(self, start: float, stop: float | None) -> None:
        assert self.call("fmi2SetupExperiment", 0, 0.0, start, int(stop is not None), stop or 0.0) == OK

    def initialize(self, start: float = 0.0, stop: float | None = None) -> None:
        """From instantiated to step complete, or to event mode; a failure is the test's."""
        if start != 0.0 or stop is not None:
            self.set_up(start, stop)
        assert self.call("fmi2EnterInitializationMode") == OK
        assert self.call("fmi2ExitInitializationMode") == OK, self.messages

    def bring_to(self, state: str) -> None:
        """To instantiated, initialization, step complete, event mode, continuous-time mode or terminated."""
        if state == "instantiated":
            return
        if state == "initialization":
            assert self.call("fmi2EnterInitializationMode") == OK
            return
        self.initialize()
        if state == "continuous-time mode":
            self.new_discrete_states()
            assert self.call("fmi2EnterContinuousTimeMode") == OK
        if state == "terminated":
            assert self.call("fmi2Terminate") == OK

    def start(
        self,
        choices: Mapping[str, int] | None = None,
        values: Mapping[str, float] | None = None,
        state: str = "step complete",
    ) -> Instance:
        """Set while instantiated, then brought to a state."""
        assert self.choose(choices or {}) == OK and self.set(values or {}) == OK, self.messages
        self.bring_to(state)
        return self

    # model exchange

    def new_discrete_states(self) -> EventInfo:
        info = EventInfo()
        assert self.call("fmi2NewDiscreteStates", byref(info)) == OK, self.messages
        return info

    def event(self) -> EventInfo:
        """From continuous-time mode through an event and back."""
        assert self.call("fmi2EnterEventMode") == OK, self.messages
        info = self.new_discrete_states()
        assert self.call("fmi2EnterContinuousTimeMode") == OK
        return info

    def vector(self, function: str, size: int = STATES) -> list[float]:
        """That a function of model exchange gives."""
        vector = (c_double * size)()
        assert self.call(function, vector, size) == OK, self.messages
        return list(vector)

    def states(self) -> list[float]:
        """delta, W_f, Q_f, delta_y."""
        return self.vector("fmi2GetContinuousStates")

    def rates(self) -> list[float]:
        return self.vector("fmi2GetDerivatives")

    def indicators(self) -> list[float]:
        return self.vector("fmi2GetEventIndicators", INDICATORS)

    def put_states(self, *x: float) -> int:
        """Those of states(); delta_y may be left out: 0."""
        x = (*x, 0.0) if len(x) == STATES - 1 else x
        return self.call("fmi2SetContinuousStates", (c_double * len(x))(*x), len(x))

    def step_completed(self) -> bool:
        """Whether the FMU wants an event."""
        event, end = (c_int * 1)(), (c_int * 1)()
        assert self.call("fmi2CompletedIntegratorStep", 1, event, end) == OK, self.messages
        assert end[0] == 0
        return bool(event[0])

    def step(self, t: float, h: float) -> int:
        return self.call("fmi2DoStep", t, h, 1)

    # values

    def references(self, names: Collection[str]) -> Any:
        return (c_uint * len(names))(*(self.library.variables[name].valueReference for name in names))

    def set(self, values: Mapping[str, float]) -> int:
        """Sets Reals in one call."""
        reals = (c_double * len(values))(*values.values())
        return self.call("fmi2SetReal", self.references(values), len(values), reals)

    def choose(self, values: Mapping[str, int]) -> int:
        """Sets Enumerations in one call."""
        integers = (c_int * len(values))(*values.values())
        return self.call("fmi2SetInteger", self.references(values), len(values), integers)

    def get(self, *names: str) -> list[float]:
        reals = (c_double * len(names))()
        assert self.call("fmi2GetReal", self.references(names), len(names), reals) == OK, self.messages
        return list(reals)

    def chosen(self, name: str) -> int:
        integer = (c_int * 1)()
        assert self.call("fmi2GetInteger", self.references([name]), 1, integer) == OK, self.messages
        return integer[0]

    # derivatives

    def set_input_rates(self, rates: Mapping[str, float], order: int = 1) -> int:
        orders = (c_int * len(rates))(*([order] * len(rates)))
        values = (c_double * len(rates))(*rates.values())
        return self.call("fmi2SetRealInputDerivatives", self.references(rates), len(rates), orders, values)

    def output_rate(self, name: str, order: int = 1) -> tuple[int, float]:
        value = (c_double * 1)()
        status = self.call(
            "fmi2GetRealOutputDerivatives", self.references([name]), 1, (c_int * 1)(order), value
        )
        return status, value[0]

    def directional(self, unknowns: Sequence[str], direction: Mapping[str, float]) -> tuple[int, list[float]]:
        result = (c_double * len(unknowns))()
        status = self.call(
            "fmi2GetDirectionalDerivative",
            *(self.references(unknowns), len(unknowns), self.references(direction), len(direction)),
            *((c_double * len(direction))(*direction.values()), result),
        )
        return status, list(result)

    # states

    def save(self, state: c_void_p | None = None) -> c_void_p:
        state = c_void_p() if state is None else state
        assert self.call("fmi2GetFMUstate", byref(state)) == OK, self.messages
        return state

    def restore(self, state: c_void_p) -> int:
        return self.call("fmi2SetFMUstate", state)

    def drop(self, state: c_void_p) -> int:
        return self.call("fmi2FreeFMUstate", byref(state))

    def serialize(self, state: c_void_p) -> bytes:
        size = c_size_t()
        assert self.call("fmi2SerializedFMUstateSize", state, byref(size)) == OK
        buffer = ctypes.create_string_buffer(size.value)
        assert self.call("fmi2SerializeFMUstate", state, buffer, size.value) == OK
        return buffer.raw

    def deserialize(self, data: bytes) -> tuple[int, c_void_p]:
        state = c_void_p()
        return self.call("fmi2DeSerializeFMUstate", data, len(data), byref(state)), state

    def become(self, data: bytes) -> Instance:
        """Goes to the state of those bytes."""
        status, state = self.deserialize(data)
        assert (status, self.restore(state), self.drop(state)) == (OK, OK, OK), self.messages
        return self

    def fingerprint(self) -> bytes:
        """Everything that the instance will do depends on these bytes."""
        state = self.save()
        data = self.serialize(state)
        assert self.drop(state) == OK
        return data

    @property
    def last_message(self) -> LogMessage:
        return self.messages[-1]
