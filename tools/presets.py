"""Scenes that the page of the live FMU offers and the FMU holds as parameter sets."""

from dataclasses import dataclass

import numpy as np
from lxml import etree

from frictioncontact.fmu import SETTLED
from frictioncontact.parameters import IDENTIFIED, PRINTED, TABLE_2, ParameterSet, Row, start_values
from tools.project import ROOT
from tools.validate.measurements import sliding

RELATED = ROOT / "data" / "related"


@dataclass(frozen=True)
class Preset:
    """A scene: start values of the FMU, and what is known of it from elsewhere."""

    id: str
    group: str
    title: str
    note: str  # HTML
    values: dict[str, float | str]
    known: float | None = None  # N, mean force
    known_from: str | None = None
    measured: tuple[tuple[float, float, str], ...] | None = None  # V / V_1, force over that without, text


IDENTIFIED_ROWS = (
    "identified",
    "Table 2, identified stiffness and phase",
    "Three numbers fitted to the three informative rows of Table 2: stiffness 2.5366 MN/m at 14 µm, "
    "phase 224.94°, velocity 0.5 m/s. They show that the equations can reach the rows, not that the "
    "equations are right.",
)
EXACT_ROWS = (
    "exact",
    "Table 2, exact: the printed parameters",
    "The equations at the printed parameters: where the paper's number differs, they do not give it.",
)


def presets() -> list[Preset]:
    return [*table_2(IDENTIFIED), *table_2(PRINTED), *dry_rows(), *scenes()]


def table_2(parameters: ParameterSet) -> list[Preset]:
    """The six rows of Table 2 with one set of parameters."""
    name, group, note = IDENTIFIED_ROWS if parameters is IDENTIFIED else EXACT_ROWS
    return [
        Preset(
            f"table2-row{row.number}-{name}",
            group,
            f"Row {row.number} {name}: {_conditions(row)}",
            note,
            SETTLED | start_values(row, parameters),
            known=row.paper_force,
            known_from="Paper",
        )
        for row in TABLE_2
    ]


def _conditions(row: Row) -> str:
    parts = [
        *(["E₁ −30 %"] if row.softened else []),
        *([f"{1e6 * row.a_d:g} µm normal"] if row.a_d else []),
        *([f"{row.V_1:g} m/s along"] if row.V_1 else []),
    ]
    return ", ".join(parts) or "no vibration"


def dry_rows() -> list[Preset]:
    """Luo et al. 2024, Fig. 5b: each row that slides, with its measured force without vibration as F_C."""
    data = sliding("dry")
    rows = np.column_stack([data.V, data.without, data.vibrated]).tolist()
    points = tuple((V / data.V_1, F / F_C, f"{1e3 * V:g} mm/s: {F:g} of {F_C:g} N") for V, F_C, F in rows)
    return [
        Preset(
            f"luo2024-dry-{1e3 * V:g}mm-s",
            "Measured: 26 kHz along the sliding",
            f"Dry steel, measured: {1e3 * V:g} mm/s",
            "L. Luo et al., <i>Sci. Rep.</i> 14:25847 (2024), Fig. 5b. The limit is the force measured "
            "without vibration at this velocity; one stiffness, 7.76 MN/m, is fitted to all five rows. Their "
            "ratios are the points of figure c.",
            SETTLED
            | {
                "friction.model": "ElasticPlastic",
                "contact.model": "Constant",
                "contact.sigma": 7.76e6,
                "contact.input": "Load",
                "load": 10.8,
                "F_C": without,
                "V": V,
                "vibration.f": data.f,
                "vibration.V_1": data.V_1,
            },
            known=force,
            known_from="Measured",
            measured=points,
        )
        for V, without, force in rows
    ]


SCENES = {  # the note on each; its title and its values stand in data/related/ID.ssv
    "stick-slip": "A resting body on a belt of 10 mm/s + 50 mm/s cos(2π 2 Hz t), LuGre's law. Where the belt "
    "slows below the Stribeck velocity the friction rises towards the static one; after each turn the "
    "contact sticks and is loaded like a spring.",
    "transverse": "The vibration of 1.44 m/s is transverse to the sliding. The force turns after the "
    "velocity (figure b), so little is left of it along the sliding.",
    "ellipse": "The surfaces vibrate in an ellipse of the plane while they slide at an angle. The mean force "
    "has a transverse part, and it need not point against the sliding.",
    "ultrasonic-motor": "The slider runs at 0.1 m/s over a stator of 40 kHz. While the stator moves with the "
    "slider it is pressed on harder, so the mean friction is negative: it drives. Figure c is the motor's "
    "force over its speed.",
}


def scenes() -> list[Preset]:
    found = []
    for name, note in SCENES.items():
        root = etree.parse(RELATED / f"{name}.ssv").getroot()
        given = {each.get("name"): each[0].get("value") for each in root.iterfind("*/*")}
        values = {variable: _value(text) for variable, text in given.items()}
        found.append(Preset(name, "Scenes", root.get("name"), note, values))
    return found


def _value(text: str) -> float | str:
    """A number, or the name of an enumeration's item."""
    return text if text.isidentifier() else float(text)
