"""Mean friction of a bristle that sticks and slips over many periods: what every call says of it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
import pytest

import frictioncontact as fc
from frictioncontact.fmu import FrictionFmu, Value

SCENE: dict[str, Value] = {
    "friction.model": "ElasticPlastic",
    "friction.staticRatio": 1.5,
    "friction.V_S": 0.05,
    "F_C": 50.0,
    "contact.model": "Constant",
    "contact.sigma": 4e6,
    "vibration.V_1": 0.3,
    "V": 0.003,
}
ALIKE = 0.02  # of means over this long and over another, which end within other cycles


def long_mean(fmu: FrictionFmu, scene: Mapping[str, Value]) -> float:
    """Of F_t [N] over 8000 periods that are simulated from rest, without the first 400."""
    with fmu.session(scene) as session:
        session.step(0.02)
        session.step(0.4)
        return session.get("F_t_mean")


def test_advise_and_sweep(fmu: FrictionFmu, fmu_path: Path, tmp_path: Path) -> None:
    assert fc.advise(SCENE, fmu=fmu_path).mean == pytest.approx(long_mean(fmu, SCENE), rel=ALIKE)
    held = {name: value for name, value in SCENE.items() if name != "V"}
    swept = fc.sweep(output=tmp_path, vary={"V": [-0.01]}, set=held, fmu=fmu_path)
    for row in pd.read_parquet(swept.results).itertuples():
        assert row.F_mean == pytest.approx(long_mean(fmu, SCENE | {"V": row.V}), rel=ALIKE)
