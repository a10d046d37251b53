"""What a worker does not survive, in a module that it imports fast."""

from __future__ import annotations

import os

import numpy as np

from frictionlab.sweep.scenario import Results


def deadly(work: object, values: dict[str, np.ndarray]) -> Results:
    """Scenario 3 kills its process."""
    if 3 in values["number"]:
        os._exit(1)
    return Results({"seconds": values["number"] * 1e-3})
