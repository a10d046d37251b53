"""Dry friction between rough surfaces under vibration: the FMU FrictionContact, and what one does with it.

    import frictioncontact as fc

    # one scene, as a table
    fc.simulate({"V": 0.5, "vibration.V_1": 1.44}, stop=1e-3, step=5e-5)
    # thousands of scenes
    fc.simulate_many({"V": velocities}, ["F_t_mean"])
    # parameters from measurements
    fc.identify("mine.csv", fit=["contact.stiffnessScale"])
    # what to set for an accuracy
    fc.advise({"V": 0.5, "vibration.V_1": 1.44}, accuracy=1e-3)
    # millions of scenes, into Parquet
    fc.sweep(output="sweep", random=10**6, vary={"V": "0.01:1:log"})
    # the .fmu file, for other tools
    fc.FMU

Variables have their names in the FMU, all values are in SI units. What is wrong with them is a UserError in
one line. Modules are imported when what they hold is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from .advice.answer import Advice, advise
    from .batch import BatchError, simulate_many
    from .errors import UserError
    from .fmu import FrictionError, FrictionFmu
    from .identification.api import Identification, identify
    from .simulation.run import simulate
    from .sweeps.run import Swept, sweep

    FMU: Path
    __version__: str

_HOME = {
    "simulate": "simulation.run",
    "simulate_many": "batch",
    "identify": "identification.api",
    "Identification": "identification.api",
    "advise": "advice.answer",
    "Advice": "advice.answer",
    "sweep": "sweeps.run",
    "Swept": "sweeps.run",
    "FrictionFmu": "fmu",
    "UserError": "errors",
    "FrictionError": "fmu",
    "BatchError": "batch",
}
__all__ = [
    "FMU",
    "Advice",
    "BatchError",
    "FrictionError",
    "FrictionFmu",
    "Identification",
    "Swept",
    "UserError",
    "advise",
    "identify",
    "simulate",
    "simulate_many",
    "sweep",
]


def __getattr__(name: str) -> object:
    """What is exported, imported at its first use (PEP 562)."""
    if name in _HOME:
        value = getattr(importlib.import_module(f"{__name__}.{_HOME[name]}"), name)
    elif name == "FMU":
        from .resources import fmu

        value = fmu()
    elif name == "__version__":
        from importlib.metadata import version

        value = version("frictioncontact")
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
