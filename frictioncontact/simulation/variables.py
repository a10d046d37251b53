"""`variables`: what the FMU takes and gives, as a table."""

from pathlib import Path

import pandas as pd

from frictioncontact.fmu import opened


def variables(fmu: str | Path | None = None) -> pd.DataFrame:
    """Every variable of the FMU, from its model description.

    fmu       another .fmu file of this model
    returns   a frame, a row for each name: causality, variability, unit, start, min, max (inclusive), items
              (of an enumeration name -> number), meaning
    raises    UserError: not an FMU of this model

        import frictioncontact as fc
        print(fc.variables().loc["vibration.V_1"])
        print(fc.variables().query("causality == 'input'")[["unit", "start", "meaning"]])
    """
    known = opened(fmu).known
    starts = known.starts()
    rows = {
        name: {
            "causality": variable.causality,
            "variability": variable.variability,
            "unit": variable.unit or "",
            "start": starts.get(name),
            "min": None if variable.min is None else float(variable.min),
            "max": None if variable.max is None else float(variable.max),
            "items": {item: int(number) for item, number in known.items[name].items()} or None,
            "meaning": variable.description,
        }
        for name, variable in known.all.items()
    }
    return pd.DataFrame.from_dict(rows, orient="index")
