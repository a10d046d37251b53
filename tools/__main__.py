"""Runs a command's module, as the files of scripts/ do:

    python -m tools figures.report.command ARGS
    python -m tools frictioncontact.identification.command ARGS

What users install takes the FMU as it finds it. From here it is called scripts/NAME, and the FMU is built
before, unless the command needs none or --fmu names another.
"""

import importlib
import sys
from collections.abc import Callable
from types import ModuleType

from frictioncontact.__main__ import interruptible

SCRIPTS = {
    "table2": "run",
    "identification": "identify",
    "advice": "advise",
    "sweeps": "sweep",
}  # room -> file of scripts/


def main() -> None:
    del sys.argv[0]
    interruptible(lambda: _loaded(sys.argv[0]))


def _loaded(module: str) -> Callable[[], None]:
    from frictioncontact.command import main_of

    command = importlib.import_module(module)
    run = main_of(command)
    if not module.startswith("frictioncontact."):
        return run

    def prepare_and_run() -> None:
        prepare(command, module.split(".")[1])
        run()

    return prepare_and_run


def prepare(command: ModuleType, name: str) -> None:
    """Calls a command of frictioncontact/ as the clone does, and builds the FMU that it uses."""
    from frictioncontact import command as shared

    shared.called_as = "scripts/" + SCRIPTS.get(name, name)
    options = command.arguments()  # wrong ones are refused before the build
    if getattr(options, "fmu", "none is needed") is None:
        from tools.build import build_fmu

        shared.finish(lambda options: build_fmu(), options)


if __name__ == "__main__":
    main()
