"""Dry friction between rough surfaces under vibration: the FMU FrictionContact, and what one does with it.

    import frictioncontact as fc
    scene = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}
    # the friction law that a machine sees, as a function
    law = fc.friction_law(scene)
    print(law([0.1, 0.5, 1.0]), law.derivative(0.5))
    # one scene over time, as a table
    fc.simulate(scene, stop=1e-3, step=5e-5, outputs=["F_t_mean"])
    # thousands of scenarios
    fc.simulate_many({**scene, "V": [0.1, 0.5, 1.0]}, ["F_t_mean"])
    # a measured contact, and a fit to its measurements
    steel = fc.contacts["steel-dry"]
    law = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
    print(fc.identify(steel.data, fit="contact.sigma", start=law))
    # what to set for an accuracy
    print(fc.advise(scene, accuracy=1e-3))
    # every variable, and the .fmu file for other tools
    print(fc.variables(), fc.FMU)

`fc.sweep` runs millions of scenarios into Parquet. Variables have their names in the FMU, all values are in
SI units. A name or a value that is wrong is a UserError of one line, a ValueError; a scene that was hardly
meant gives a FrictionWarning. Modules are imported when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from .advice.answer import Advice, advise
    from .batch import simulate_many
    from .errors import BatchError, FrictionError, FrictionWarning, UserError
    from .exchange import ModelExchange
    from .fmu import FrictionFmu
    from .identification.api import Identification, identify
    from .law import FrictionLaw, friction_law
    from .measured import Contact, Contacts
    from .simulation import simulate, variables
    from .sweeps.run import Swept, sweep

    FMU: Path
    contacts: Contacts
    __version__: str

_HOME = {
    "simulate": "simulation",
    "variables": "simulation",
    "friction_law": "law",
    "FrictionLaw": "law",
    "Contact": "measured",
    "simulate_many": "batch",
    "identify": "identification.api",
    "Identification": "identification.api",
    "advise": "advice.answer",
    "Advice": "advice.answer",
    "sweep": "sweeps.run",
    "Swept": "sweeps.run",
    "FrictionFmu": "fmu",
    "ModelExchange": "exchange",
    "UserError": "errors",
    "FrictionError": "errors",
    "BatchError": "errors",
    "FrictionWarning": "errors",
}
__all__ = [
    "FMU",
    "Advice",
    "BatchError",
    "Contact",
    "FrictionError",
    "FrictionFmu",
    "FrictionLaw",
    "FrictionWarning",
    "Identification",
    "ModelExchange",
    "Swept",
    "UserError",
    "advise",
    "contacts",
    "friction_law",
    "identify",
    "simulate",
    "simulate_many",
    "sweep",
    "variables",
]


def __getattr__(name: str) -> object:
    """What is exported, imported at its first use (PEP 562)."""
    if name in _HOME:
        value = getattr(importlib.import_module(f"{__name__}.{_HOME[name]}"), name)
    elif name == "FMU":
        from .resources import fmu

        value = fmu()
    elif name == "contacts":
        from .measured import contacts

        value = contacts()
    elif name == "__version__":
        from importlib.metadata import version

        value = version("frictioncontact")
    else:
        from .errors import did_you_mean

        hint = did_you_mean(name, __all__, likeness=0.65)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{hint}", name=name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
