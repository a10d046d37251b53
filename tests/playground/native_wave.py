"""The same numbers from the FMU's shared library: the calls of the page's wave, made through fmpy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from frictionlab.fmu import FrictionFmu, Value

SAMPLES = 240  # a period
PERIODS = 2
SETTLING_PERIODS = 1e4
SETTLING_TIME = 1e9  # s, without vibration


@dataclass(frozen=True)
class Wave:
    force: list[float]  # N
    mean: float  # N
    work: float  # J a period


def wave(fmu: FrictionFmu, values: Mapping[str, Value]) -> Wave:
    with fmu.session(values) as session:
        f = session.get("vibration.f")
        if "initialState" not in fmu.variables:
            vibrates = session.get("vibration.V_1") > 0 or session.get("vibration.a_d") > 0
            session.step(SETTLING_PERIODS / f if vibrates else SETTLING_TIME)
        work = session.get("W_f")
        force, means = [session.get("F_t")], []
        for _ in range(PERIODS * SAMPLES):
            session.step(1.0 / f / SAMPLES)
            force.append(session.get("F_t"))
            means.append(session.get("F_t_mean"))
        work = (session.get("W_f") - work) / PERIODS
    return Wave(force, sum(means) / len(means), work)
