"""Any sequence of calls, against a model of what an instance remembers: a few lines of Python, no physics.

The model knows the place in the call order, the time, the inputs and their rates, the parameters and saved
states. It foretells each status, and what can be read; a refused call must change nothing.
"""

from __future__ import annotations

import math
from copy import deepcopy
from ctypes import c_double, c_int, c_void_p
from dataclasses import dataclass, field
from fractions import Fraction

from fmi_library import ERROR, LAST_SUCCESSFUL_TIME, OK, Instance, Library
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule, run_state_machine_as_test

FIXED = {"delta_0": 0.0, "contact.R_q": 6e-6, "solver.stepSize": 1e-8}
TUNABLE = {"F_C": 55.0, "contact.stiffnessScale": 1.0, "vibration.V_1": 0.0}
INPUTS = {"V": 0.005, "d": 14e-6, "E": 58.556936170e9}
LEAST = {"F_C": 1e-12, "contact.stiffnessScale": 1e-15, "vibration.V_1": 0.0}
LEAST |= {"contact.R_q": 1e-12, "solver.stepSize": 1e-15}

GOOD = {
    "V": st.floats(-1, 1),
    "d": st.floats(10e-6, 20e-6),
    "E": st.floats(1e9, 1e12),
    "F_C": st.floats(0.1, 1e3),
    "contact.stiffnessScale": st.floats(1e-6, 2),
    "vibration.V_1": st.sampled_from([0.0, 0.01, 0.7]),
    "delta_0": st.floats(-1e-9, 1e-9),
    "contact.R_q": st.floats(3e-6, 9e-6),
    "solver.stepSize": st.floats(1e-9, 1e-7),
}
BAD = st.sampled_from([math.nan, math.inf, -math.inf, -1e-3, 0.0])
REAL_VALUES = st.sampled_from(sorted(GOOD)).flatmap(
    lambda name: st.tuples(st.just(name), st.one_of(GOOD[name], GOOD[name], BAD))
)
STEPS = st.sampled_from([0.0, 1e-9, 1.7e-6, 5e-5, 1e-3, 1e6, -1e-6, math.nan, math.inf])
RATES = st.sampled_from([("V", 10.0), ("V", -3.0), ("V", 0.0), ("d", 1e-2), ("E", 1e14), ("E", -1e16)])


@dataclass
class Model:
    state: str = "instantiated"
    start: float = 0.0
    stop: float | None = None
    time: float = 0.0
    values: dict[str, float] = field(default_factory=lambda: {**INPUTS, **TUNABLE, **FIXED})
    rates: dict[str, float] = field(default_factory=dict)

    def can_set(self, name: str) -> bool:
        between_steps = self.state == "step complete" and name not in FIXED
        return self.state in ("instantiated", "initialization") or between_steps

    def allows(self, name: str, value: float) -> bool:
        return math.isfinite(value) and value >= LEAST.get(name, -math.inf)

    def works(self, values: dict[str, float] | None = None) -> bool:
        """d and E can be set to anything, but the scene uses them."""
        now = {**self.values, **(values or {})}
        return now["d"] > 0 and now["E"] > 0

    def after_rates(self, h: float) -> dict[str, float]:
        ends = {name: self.values[name] + rate * h for name, rate in self.rates.items()}
        if "E" in ends:  # with one rounding
            ends["E"] = float(Fraction(self.values["E"]) + Fraction(self.rates["E"]) * Fraction(h))
        return ends

    def step_is_legal(self, t: float, h: float) -> bool:
        begins = self.state == "step complete" and self.works() and t == self.time
        if not (begins and math.isfinite(h) and h >= 0):
            return False
        if self.stop is not None and t + h > self.stop * (1 + 1e-9):
            return False
        after = self.after_rates(h)
        decade = 0.1 <= after.get("E", self.values["E"]) / self.values["E"] <= 10.0
        return decade and self.works(after)


class Machine(RuleBasedStateMachine):
    library: Library  # set by the test

    def __init__(self) -> None:
        super().__init__()
        self.instance = Instance(self.library)
        self.model = Model()
        self.saved: list[tuple[c_void_p, Model]] = []

    def teardown(self) -> None:
        for handle, _ in self.saved:
            assert self.instance.drop(handle) == OK
        self.instance.free()

    def expect(self, legal: bool, function: str, *arguments: object) -> bool:
        """Calls; the status must be the foretold one, and a refusal says why and changes nothing."""
        before = self.instance.fingerprint()
        self.instance.messages.clear()
        status = self.instance.call(function, *arguments)
        assert status == (OK if legal else ERROR), (function, self.model, self.instance.messages)
        errors = [message for message in self.instance.messages if message.status == ERROR]
        assert len(errors) == (0 if legal else 1)
        if not legal:
            assert self.instance.fingerprint() == before
        return legal

    @rule(start=st.sampled_from([0.0, -5.0, 1e3, math.nan]), length=st.sampled_from([None, 1.0, 1e-4, -1.0]))
    def set_up(self, start: float, length: float | None) -> None:
        stop = None if length is None else start + length
        legal = self.model.state == "instantiated" and math.isfinite(start) and (length or 0) >= 0
        arguments = (0, 0.0, start, int(stop is not None), stop or 0.0)
        if self.expect(legal, "fmi2SetupExperiment", *arguments):
            self.model.start, self.model.stop = start, stop

    @rule()
    def enter_initialization(self) -> None:
        if self.expect(self.model.state == "instantiated", "fmi2EnterInitializationMode"):
            self.model.state, self.model.time = "initialization", self.model.start

    @rule()
    def exit_initialization(self) -> None:
        legal = self.model.state == "initialization" and self.model.works()
        if self.expect(legal, "fmi2ExitInitializationMode"):
            self.model.state = "step complete"

    @rule()
    def terminate(self) -> None:
        if self.expect(self.model.state == "step complete", "fmi2Terminate"):
            self.model.state = "terminated"

    @rule()
    def reset(self) -> None:
        self.expect(True, "fmi2Reset")
        self.model = Model()

    @rule(choices=st.lists(REAL_VALUES, min_size=1, max_size=2))
    def set_reals(self, choices: list[tuple[str, float]]) -> None:
        legal = all(self.model.can_set(n) and self.model.allows(n, v) for n, v in choices)
        count, references = len(choices), self.instance.references([name for name, _ in choices])
        values = (c_double * count)(*(value for _, value in choices))
        if self.expect(legal, "fmi2SetReal", references, count, values):
            self.model.values.update(choices)

    @rule(choice=RATES)
    def set_rate(self, choice: tuple[str, float]) -> None:
        name, rate = choice
        arguments = (self.instance.references([name]), 1, (c_int * 1)(1), (c_double * 1)(rate))
        if self.expect(self.model.state != "terminated", "fmi2SetRealInputDerivatives", *arguments):
            self.model.rates[name] = rate

    @rule(h=STEPS, late=st.sampled_from([0.0, 0.0, 0.0, 7.0]))
    def step(self, h: float, late: float) -> None:
        t = self.model.time + late
        moving = {name for name, rate in self.model.rates.items() if rate}
        shaken = moving and self.model.values["vibration.V_1"] > 0
        if h > 1e-3 and (shaken or moving & {"d", "E"}):
            return  # work in proportion to the periods, or to the change: such steps may be refused
        if self.expect(self.model.step_is_legal(t, h), "fmi2DoStep", t, h, 1):
            self.model.values.update(self.model.after_rates(h))
            self.model.rates.clear()
            self.model.time = t + h

    @rule()
    def save(self) -> None:
        self.saved.append((self.instance.save(), deepcopy(self.model)))

    @rule(data=st.data())
    def restore(self, data: st.DataObject) -> None:
        if self.saved:
            handle, model = data.draw(st.sampled_from(self.saved))
            assert self.instance.restore(handle) == OK
            self.model = deepcopy(model)

    @rule(data=st.data())
    def move_to_a_new_instance(self, data: st.DataObject) -> None:
        """The rest of the run happens in another instance, from the bytes."""
        bytes_before = self.instance.fingerprint()
        old, self.instance = self.instance, Instance(self.library)
        self.instance.become(bytes_before)
        assert self.instance.fingerprint() == bytes_before
        old.free()

    @invariant()
    def what_can_be_read_is_what_was_set(self) -> None:
        model, names = self.model, list(self.model.values)
        values = (c_double * len(names))()
        status = self.instance.call("fmi2GetReal", self.instance.references(names), len(names), values)
        assert status == (ERROR if model.state == "instantiated" else OK)
        if status == OK:
            assert dict(zip(names, values, strict=True)) == model.values
            outputs = ("F_t", "F_t_mean", "W_f", "sigma", "delta")
            results = (c_double * len(outputs))()
            status = self.instance.call(
                "fmi2GetReal", self.instance.references(outputs), len(outputs), results
            )
            assert status == (OK if model.works() else ERROR)
            assert all(map(math.isfinite, results))

    @invariant()
    def the_time_is_the_end_of_the_last_step(self) -> None:
        reached = (c_double * 1)()
        known = self.model.state in ("step complete", "terminated")
        status = self.instance.call("fmi2GetRealStatus", LAST_SUCCESSFUL_TIME, reached)
        assert status == (OK if known else ERROR)
        assert not known or reached[0] == self.model.time


def test_calls_in_any_order(library: Library) -> None:
    Machine.library = library
    how = settings(max_examples=60, stateful_step_count=40, deadline=None, derandomize=True, database=None)
    how = settings(how, suppress_health_check=list(HealthCheck))
    run_state_machine_as_test(Machine, settings=how)
