"""The paper's numbers against what its own equations give: the abstract's claims, from the FMU."""

from dataclasses import dataclass

import numpy as np

from frictioncontact.fmu import FrictionFmu
from frictioncontact.parameters import IDENTIFIED, PRINTED, TABLE_2
from frictioncontact.periodic import periodic_waves, reduction
from frictioncontact.table2 import mean_force
from workshop.paper.figures import (
    A_D,
    PRINTED_AREA,
    PRINTED_MEAN_AREA,
    PRINTED_MEAN_SIGMA,
    PRINTED_SIGMA,
    start,
)


@dataclass(frozen=True)
class Claim:
    """Changes in percent, negative for a reduction."""

    words: str
    printed: float
    exact: float
    identified: float | None  # None where the number does not depend on what was identified
    why: str


def claims(fmu: FrictionFmu) -> list[Claim]:
    """What the abstract and the conclusion state, in their order."""
    changes = {
        row.number: tuple(
            -reduction(mean_force(fmu, row, parameters), mean_force(fmu, TABLE_2[0], parameters))
            for parameters in (PRINTED, IDENTIFIED)
        )
        for row in TABLE_2
    }
    area, stiffness = mean_changes(fmu)
    constant_V = "V is constant and positive, so the periodic mean is F_C whatever σ does"
    convex = "convex in d: the mean over a symmetric oscillation rises (Jensen)"
    return [
        Claim(
            "friction, all effects together (Table 2, row 2)",
            -62.0,
            *changes[2],
            "at V / V_1 = 0.0035 hardly any friction is left; 62 % needs another V and σ",
        ),
        Claim(
            "friction, velocity oscillation (row 3)",
            -51.0,
            *changes[3],
            "from −99.45 % (soft) to −99.78 % (stiff) at V / V_1 = 0.0035, no σ gives −51 %",
        ),
        Claim("friction, moving separation and contact area (row 4)", -12.0, *changes[4], constant_V),
        Claim("friction, Young's modulus (row 5)", -1.0, *changes[5], constant_V),
        Claim(
            "mean contact area under d = 14 ± 1.1 µm",
            100.0 * (PRINTED_MEAN_AREA / PRINTED_AREA - 1.0),
            area,
            None,
            convex,
        ),
        Claim(
            "mean contact stiffness under d = 14 ± 1.1 µm",
            100.0 * (PRINTED_MEAN_SIGMA / PRINTED_SIGMA - 1.0),
            stiffness,
            None,
            convex,
        ),
    ]


def mean_changes(fmu: FrictionFmu) -> tuple[float, float]:
    """Changes [%] of the time means of A_r and sigma under the paper's oscillation of d, from the FMU."""
    names = ("A_r", "sigma")
    run = periodic_waves(fmu, start(PRINTED, PRINTED.V, a_d=A_D), names, periods=1)
    with fmu.session(start(PRINTED, PRINTED.V)) as session:
        still = session.read(names)
    means = np.array([np.mean(run[name][:-1]) for name in names])
    area, stiffness = 100.0 * (means / still - 1.0)
    return float(area), float(stiffness)
