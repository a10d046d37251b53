"""Table 2 of the paper from the FMU: the mean friction force of its six rows, and the force over time.

Three numbers a row. The paper's; the exact one, which is what Eq. 1-2 give at the printed parameters; and the
identified one, with two numbers (stiffness, phase) fitted to the table's three informative rows. The last
shows that the equations can reach those rows. It does not show that they are right.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frictionlab.fmu import FrictionFmu, periodic_mean
from frictionlab.parameters import (
    E_1_REDUCTION,
    IDENTIFIED,
    PERIOD,
    PRINTED,
    TABLE_2,
    ParameterSet,
    Row,
    start_values,
)

SETTLING_PERIODS = 1_000_000  # in one communication step: what stays then is periodic


@dataclass(frozen=True)
class Wave:
    """F_t over time in the periodic state."""

    time: np.ndarray  # s, from the start of a vibration period
    force: np.ndarray  # N


@dataclass(frozen=True)
class Result:
    """One row of Table 2: mean forces in N."""

    row: Row
    exact: float
    identified: float


def results(fmu: FrictionFmu) -> Iterator[Result]:
    """The six rows, one after the other."""
    for row in TABLE_2:
        yield Result(row, mean_force(fmu, row, PRINTED), mean_force(fmu, row, IDENTIFIED))


def mean_force(fmu: FrictionFmu, row: Row, parameters: ParameterSet) -> float:
    """F_t_mean [N] of one period in the periodic state."""
    return periodic_mean(fmu, start_values(row, parameters), SETTLING_PERIODS)


def wave(fmu: FrictionFmu, row: Row, parameters: ParameterSet, periods: int = 2, samples: int = 400) -> Wave:
    """F_t at samples points a period."""
    step = PERIOD / samples
    force = []
    with fmu.session(start_values(row, parameters)) as session:
        session.step(SETTLING_PERIODS * PERIOD)
        force.append(session.get("F_t"))
        for _ in range(periods * samples):
            session.step(step)
            force.append(session.get("F_t"))
    return Wave(step * np.arange(len(force)), np.array(force))


def reduction(mean: float, without: float) -> float:
    """Percent by which the mean force lies below the one without vibration."""
    return 100.0 * (without - mean) / without


CSV_COLUMNS = (
    "row",
    "E_1_reduction_percent",
    "a_d_um",
    "V_1_m_per_s",
    "paper_N",
    "paper_reduction_percent",
    "exact_N",
    "exact_reduction_percent",
    "identified_N",
    "identified_reduction_percent",
)


def write_csv(table: Sequence[Result], path: Path) -> None:
    """One line a row; columns as in CSV_COLUMNS."""
    first = table[0]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(CSV_COLUMNS)
        for result in table:
            row = result.row
            writer.writerow(
                [
                    row.number,
                    100.0 * E_1_REDUCTION * row.softened,
                    round(1e6 * row.a_d, 6),
                    row.V_1,
                    row.paper_force,
                    row.paper_reduction,
                    result.exact,
                    reduction(result.exact, first.exact),
                    result.identified,
                    reduction(result.identified, first.identified),
                ]
            )


def conditions(row: Row, separator: str = ", ") -> str:
    """What is switched on in a row, for headings."""
    parts = []
    if row.softened:
        parts.append(f"$E_1$ −{100 * E_1_REDUCTION:.0f} %")
    if row.a_d:
        parts.append(f"$a_d$ {1e6 * row.a_d:.1f} µm")
    if row.V_1:
        parts.append(f"$V_1$ {row.V_1:.2f} m/s")
    return separator.join(parts) or "no vibration"
