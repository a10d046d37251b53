"""Scenes that the page of the live FMU offers and the FMU holds as parameter sets: the one place for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from frictionlab.parameters import IDENTIFIED, PRINTED, TABLE_2, ParameterSet, Row, start_values


@dataclass(frozen=True)
class Preset:
    """A scene: start values of the FMU, and what is known of it from elsewhere."""

    id: str
    group: str
    title: str
    note: str  # HTML
    values: dict[str, float | str]
    paper: float | None = None  # N, mean force that the paper prints
    measured: tuple[tuple[float, float, str], ...] | None = None  # V / V_1, force over that without, text


def presets() -> list[Preset]:
    return [*table_2(IDENTIFIED), *table_2(PRINTED), *scenes()]


def possible(presets: Sequence[Preset], variables: Sequence[Mapping[str, Any]]) -> list[Preset]:
    """Those whose variables and items are among the variables of description()."""
    known = {variable["name"]: variable for variable in variables}
    return [
        preset
        for preset in presets
        if all(
            name in known and (not isinstance(value, str) or value in _items(known[name]))
            for name, value in preset.values.items()
        )
    ]


def _items(variable: Mapping[str, Any]) -> list[str]:
    return [item["name"] for item in variable["items"]]


def table_2(parameters: ParameterSet) -> list[Preset]:
    """The six rows of Table 2 with one set of parameters."""
    name = "identified" if parameters is IDENTIFIED else "exact"
    group = (
        "Table 2, identified stiffness and phase"
        if parameters is IDENTIFIED
        else "Table 2, exact: the printed parameters"
    )
    return [
        Preset(
            f"table2-row{row.number}-{name}",
            group,
            f"Row {row.number} {name}: {_conditions(row)}",
            _table_2_note(parameters),
            start_values(row, parameters),
            paper=row.paper_force,
        )
        for row in TABLE_2
    ]


def _conditions(row: Row) -> str:
    parts = [
        *(["E₁ −30 %"] if row.softened else []),
        *([f"{1e6 * row.a_d:g} µm across"] if row.a_d else []),
        *([f"{row.V_1:g} m/s along"] if row.V_1 else []),
    ]
    return ", ".join(parts) or "no vibration"


def _table_2_note(parameters: ParameterSet) -> str:
    if parameters is IDENTIFIED:
        return (
            "Three numbers fitted to the three informative rows of Table 2: stiffness 2.5366 MN/m at 14 µm, "
            "phase 224.94°, velocity 0.5 m/s. They show that the equations can reach the rows, not that the "
            "equations are right."
        )
    return "The equations at the printed parameters: where the paper's number differs, they do not give it."


def scenes() -> list[Preset]:
    group = "Scenes"
    return [
        Preset(
            "stick-slip",
            group,
            "Stick and slip: a belt that moves to and fro",
            "A resting body on a belt of 10 mm/s + 50 mm/s cos(2π 2 Hz t), as in the example of a mass on a "
            "belt: after each turn the contact sticks and is loaded like a spring, then it slips.",
            {
                "V": 0.01,
                "vibration.V_1": 0.05,
                "vibration.f": 2.0,
                "contact.stiffnessScale": IDENTIFIED.stiffnessScale,
            },
        ),
    ]
