"""scripts/identify always ends: random fits of two to four parameters in every law.

The slowest are shown by `scripts/test tests/commands/test_random_fits.py --durations 5`.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from frictioncontact.errors import quiet
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification.data import Measurements
from frictioncontact.identification.experiment import Rows
from frictioncontact.identification.fit import fit
from frictioncontact.identification.parameter import parameter

SEEDS = (3, 4)  # some others take ten seconds
TRUTHS = {  # ranges that true values are drawn from, by their logarithms
    "F_C": (20.0, 150.0),
    "friction.sigma_2": (0.5, 20.0),
    "vibration.phase_d": (0.1, 6.2),
    "contact.sigma": (1e5, 1e9),
    "contact.stiffnessScale": (1e-7, 1e-3),
    "d": (10e-6, 18e-6),
    "friction.staticRatio": (1.05, 2.5),
    "friction.V_S": (5e-3, 0.5),
}
STATELESS = ("F_C", "friction.sigma_2")
LAWS = {
    "Coulomb": STATELESS,
    "ElasticPlastic": (*STATELESS, "vibration.phase_d", "contact.stiffnessScale", "contact.sigma", "d"),
    "Dahl": (*STATELESS, "vibration.phase_d", "contact.stiffnessScale", "contact.sigma", "d"),
    "LuGre": (*STATELESS, "contact.stiffnessScale", "contact.sigma", "friction.staticRatio", "friction.V_S"),
}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("law", LAWS)
def test_ends_with_no_more_misfit_than_the_truth_has(fmu: FrictionFmu, law: str, seed: int) -> None:
    random = np.random.default_rng([list(LAWS).index(law), seed])
    names = random.choice(LAWS[law], min(len(LAWS[law]), int(random.integers(2, 5))), replace=False).tolist()
    contact = "Constant" if "contact.sigma" in names or random.random() < 0.5 else "Asperities"
    constants = {"friction.model": law, "contact.model": contact}
    if contact == "Asperities" and "contact.stiffnessScale" not in names:
        constants["contact.stiffnessScale"] = 5e-7
    truth = [math.exp(random.uniform(*np.log(TRUTHS[name]))) for name in names]
    count = int(random.integers(len(names) + 1, 17))
    conditions = [
        {
            **constants,
            "V": math.exp(random.uniform(math.log(0.01), 0.0)),
            "vibration.V_1": random.uniform(0.1, 1.5),
            "vibration.a_d": random.choice([0.0, 1e-6]),
        }
        for _ in range(count)
    ]
    columns = ("V", "vibration.V_1", "vibration.a_d")
    named = [parameter(fmu, name, None, None, constants) for name in names]
    rows = Measurements(columns, conditions, [0.0] * count, None)
    exact = Rows(fmu, rows, named).means([p.to_coordinate(x) for p, x in zip(named, truth, strict=True)])
    noise = random.choice([0.01, 0.3, 2.0])
    force = exact + noise * random.standard_normal(count)
    stated = [noise] * count if random.random() < 0.5 else None
    with quiet():
        result = fit(Rows(fmu, Measurements(columns, conditions, force.tolist(), stated), named))
    assert np.sum(result.residuals**2) <= 1.001 * np.sum((force - exact) ** 2)
