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
    mean: float  # N
    work: float  # J a period
    heat: float  # J a period


def wave(fmu: FrictionFmu, values: Mapping[str, Value]) -> Wave:
    with fmu.session(values) as session:
        f = session.get("vibration.f")
        work, heat = session.read(["W_f", "Q_f"])
        force, means = [session.get("F_t")], []
        for _ in range(PERIODS * SAMPLES):
            session.step(1.0 / f / SAMPLES)
            force.append(session.get("F_t"))
            means.append(session.get("F_t_mean"))
        work, heat = (session.read(["W_f", "Q_f"]) - [work, heat]) / PERIODS
    return Wave(force, sum(means) / len(means), work, heat)
