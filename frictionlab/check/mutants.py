"""Do the tests notice when a capability of modelDescription.xml does nothing?

The FMU is compiled again and again, each time with one function spoilt: the tests that back its flag must
fail.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from frictionlab.build import build_fmu
from frictionlab.check.workshop import SHIPPED, Workshop
from frictionlab.project import ROOT


@dataclass(frozen=True)
class Mutant:
    flag: str  # attribute of CoSimulation, or the element that promises it
    source: str  # under fmu_src
    old: str  # replaced by new; just a function's name: it returns fmi2OK at once
    new: str | None
    tests: str  # must fail

    @property
    def title(self) -> str:
        what = f"{self.old} does nothing" if self.new is None else f"`{self.old}` -> `{self.new}`"
        return f"{self.flag}: {' '.join(what.split())}"


MUTANTS = (
    Mutant(
        "canHandleVariableCommunicationStepSize",
        "fmi2/step.c",
        "currentCommunicationPoint, communicationStepSize,\n",
        "currentCommunicationPoint, 1e-5,\n",
        "tests/fmi2/test_steps.py",
    ),
    Mutant(
        "canHandleVariableCommunicationStepSize",
        "fmi2/step.c",
        "fmi2DoStep",
        None,
        "tests/fmi2/test_steps.py",
    ),
    Mutant(
        "canInterpolateInputs",
        "fmi2/derivatives.c",
        "fmi2SetRealInputDerivatives",
        None,
        "tests/fmi2/test_steps.py tests/fmi2/test_time_derivatives.py",
    ),
    Mutant(
        "maxOutputDerivativeOrder",
        "fmi2/derivatives.c",
        "fmi2GetRealOutputDerivatives",
        None,
        "tests/fmi2/test_time_derivatives.py",
    ),
    Mutant(
        "canBeInstantiatedOnlyOncePerProcess",
        "fmi2/lifecycle.c",
        "FcInstance* instance = calloc(1, sizeof *instance + name_size);",
        "static FcInstance* instance; if (!instance) instance = calloc(1, sizeof *instance + 1000000);",
        "tests/fmi2/test_instances.py",
    ),
    Mutant(
        "canNotUseMemoryManagementFunctions",
        "fmi2/lifecycle.c",
        "FcInstance* instance = calloc(",
        "FcInstance* instance = functions->allocateMemory(",
        "tests/fmi2/test_instances.py",
    ),
    *(
        Mutant("canGetAndSetFMUstate", "fmi2/saved_state.c", function, None, "tests/fmi2/test_saved_state.py")
        for function in ("fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate")
    ),
    *(
        Mutant(
            "canSerializeFMUstate",
            "fmi2/saved_state_bytes.c",
            function,
            None,
            "tests/fmi2/test_saved_state.py",
        )
        for function in ("fmi2SerializedFMUstateSize", "fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate")
    ),
    Mutant(
        "providesDirectionalDerivative",
        "fmi2/derivatives.c",
        "fmi2GetDirectionalDerivative",
        None,
        "tests/fmi2/test_directional_derivatives.py",
    ),
    Mutant("LogCategories", "fmi2/lifecycle.c", "fmi2SetDebugLogging", None, "tests/fmi2/test_log.py"),
    Mutant("DefaultExperiment", "fmi2/lifecycle.c", "fmi2SetupExperiment", None, "tests/fmi2/test_steps.py"),
    *(
        Mutant(
            "causality parameter, variability tunable",
            "fmi2/values.c",
            function,
            None,
            "tests/fmi2/test_values.py",
        )
        for function in ("fmi2SetReal", "fmi2SetInteger", "fmi2GetReal", "fmi2GetInteger")
    ),
    Mutant("fmi2Reset", "fmi2/lifecycle.c", "fmi2Reset", None, "tests/fmi2/test_call_order.py"),
    Mutant("fmi2Terminate", "fmi2/lifecycle.c", "fmi2Terminate", None, "tests/fmi2/test_call_order.py"),
    Mutant("fmi2GetRealStatus", "fmi2/status.c", "fmi2GetRealStatus", None, "tests/fmi2/test_steps.py"),
    Mutant("fmi2GetBooleanStatus", "fmi2/status.c", "fmi2GetBooleanStatus", None, "tests/fmi2/test_steps.py"),
)


def mutated(text: str, mutant: Mutant) -> str:
    """The source with the mutation; ValueError if the place is not there exactly once."""
    if mutant.new is None:
        found = re.findall(rf"^fmi2Status {mutant.old}\([^{{]*\) {{\n", text, re.MULTILINE)
        old, new = (found[0], found[0] + "    return fmi2OK;\n") if found else (mutant.old, "")
    else:
        old, new = mutant.old, mutant.new
    if text.count(old) != 1:
        raise ValueError(
            f"{mutant.title}: fmu_src/{mutant.source} has {text.count(old)} such places, not one"
        )
    return text.replace(old, new)


def _tests_pass(fmu: Path, tests: str) -> bool:
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *tests.split()]
    environment = {**os.environ, "FRICTION_FMU": str(fmu)}
    done = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=300
    )
    return done.returncode == 0


def check_mutations() -> list[str]:
    """Tries all mutants; gives the titles of those that no test notices."""
    with tempfile.TemporaryDirectory(prefix="friction-mutants-") as folder:
        workshop = Workshop(Path(folder), build_fmu())
        workshop.compile(SHIPPED)
        tests = sorted({name for mutant in MUTANTS for name in mutant.tests.split()})
        if not _tests_pass(workshop.fmu(), " ".join(tests)):
            return ["the sources as they are: their tests fail already"]
        unnoticed = []
        for mutant in MUTANTS:
            source = (ROOT / "fmu_src" / mutant.source).read_text()
            workshop.write(mutant.source, mutated(source, mutant), SHIPPED)
            noticed = not _tests_pass(workshop.fmu(), mutant.tests)
            workshop.write(mutant.source, source, SHIPPED)
            print(f"{'noticed' if noticed else 'NOT NOTICED'}  {mutant.title}", flush=True)
            if not noticed:
                unnoticed.append(mutant.title)
        return unnoticed
