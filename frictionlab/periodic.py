"""An FMU brought to its periodic state, and what is read from it there.

A communication step may be as long as one likes and costs what one period costs, so one step over many
periods brings any contact to its periodic state. These are the only places where that is done.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .fmu import FrictionFmu, Session, Value

SETTLING_PERIODS = 1e6  # of the vibration: what stays after them is periodic


def settle(session: Session, periods: float = SETTLING_PERIODS) -> float:
    """Brings the session to its periodic state in one step; gives the period of the vibration [s]."""
    period = 1.0 / session.get("vibration.f")
    session.step(periods * period)
    return period


def sample(session: Session, names: Sequence[str], step: float, count: int) -> np.ndarray:
    """The named variables after each of count steps of the length step [s], one row each."""
    rows = np.empty((count, len(names)))
    for k in range(count):
        session.step(step)
        rows[k] = session.read(names)
    return rows


def settled_mean(session: Session, periods: float = SETTLING_PERIODS) -> float:
    """Time mean of F_t [N] over one period of the periodic state, to which it brings the session."""
    session.step(settle(session, periods))
    return session.get("F_t_mean")


def periodic_mean(
    fmu: FrictionFmu, start_values: Mapping[str, Value], settling: float = SETTLING_PERIODS
) -> float:
    """Time mean of F_t [N] over one period of the periodic state of a scene."""
    with fmu.session(start_values) as session:
        return settled_mean(session, settling)


def periodic_waves(
    fmu: FrictionFmu,
    start_values: Mapping[str, Value],
    names: Sequence[str],
    periods: int = 2,
    samples: int = 240,
) -> dict[str, np.ndarray]:
    """Variables over some periods of the periodic state; arrays of periods * samples + 1 points.

    "time" [s] is among them, 0 at the start of a period.
    """
    with fmu.session(start_values) as session:
        step = settle(session) / samples
        rows = np.vstack([session.read(names), sample(session, names, step, periods * samples)])
    return {"time": step * np.arange(len(rows)), **dict(zip(names, rows.T, strict=True))}
