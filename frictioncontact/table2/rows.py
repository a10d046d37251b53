"""Table 2 of the paper from the FMU: the mean friction force of its six rows, and the force over time.

Three numbers a row. The paper's; the exact one, which is what Eq. 1-2 give at the printed parameters; and the
identified one, with three numbers (stiffness, phase, V) adjusted to the three informative rows. The last
shows that the equations can reach those rows. It does not show that they are right.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from frictioncontact.fmu import FrictionFmu
from frictioncontact.parameters import (
    E_1_REDUCTION,
    IDENTIFIED,
    PRINTED,
    TABLE_2,
    ParameterSet,
    Row,
    start_values,
)
from frictioncontact.periodic import periodic_mean, reduction


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
    """Time mean of F_t [N] in the periodic state."""
    return periodic_mean(fmu, start_values(row, parameters))


def csv_rows(table: Sequence[Result]) -> list[dict[str, float]]:
    """One row of table2.csv for each of the table."""
    first = table[0]
    return [
        {
            "row": result.row.number,
            "E_1_reduction_percent": 100.0 * E_1_REDUCTION * result.row.softened,
            "a_d_um": round(1e6 * result.row.a_d, 6),
            "V_1_m_per_s": result.row.V_1,
            "paper_N": result.row.paper_force,
            "paper_reduction_percent": result.row.paper_reduction,
            "exact_N": result.exact,
            "exact_reduction_percent": reduction(result.exact, first.exact),
            "identified_N": result.identified,
            "identified_reduction_percent": reduction(result.identified, first.identified),
        }
        for result in table
    ]


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
