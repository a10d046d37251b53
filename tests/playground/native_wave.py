"""The same numbers from the FMU's shared library: the calls of the page's wave, made through fmpy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from frictioncontact.fmu import FrictionFmu, Value

SAMPLES = 240  # a period
PERIODS = 2


@dataclass(frozen=True)
class Wave:
    force: list[float]  # N
    transverse: list[float]  # N
    mean: float  # N
    transverse_mean: float  # N
    work: float  # J a period
    heat: float  # J a period


def wave(fmu: FrictionFmu, values: Mapping[str, Value]) -> Wave:
    with fmu.session(values) as session:
        f = session.get("vibration.f")
        work, heat = session.read(["W_f", "Q_f"])
        force, transverse = [session.get("F_t")], [session.get("F_y")]
        for _ in range(PERIODS * SAMPLES):
            session.step(1.0 / f / SAMPLES)
            force.append(session.get("F_t"))
            transverse.append(session.get("F_y"))
        work, heat = (session.read(["W_f", "Q_f"]) - [work, heat]) / PERIODS
        mean, transverse_mean = session.read(["F_t_settled", "F_y_settled"])
    return Wave(force, transverse, mean, transverse_mean, work, heat)
