"""InitialUnknowns of modelDescription.xml: the start values and inputs on which each initial result depends.

usage: python -m tools.packing.initial_unknowns      writes them into modelDescription.xml

The build refuses a file in which they differ.
"""

import re
from pathlib import Path

from fmpy.model_description import ModelDescription

from tools import description

SECTION = re.compile(r"    <InitialUnknowns>\n.*?    </InitialUnknowns>\n", re.DOTALL)

# No force depends on these at the start. The tolerance is that of the settled state.
NOT_FORCE = {"solver.method", "solver.stepSize", "body.x_0"}
# F_t of a mass that sticks, and with it a rate, answers to the force on the mass; the bristle does not.
NOT_BRISTLE = NOT_FORCE | {"body.F"}
# A settled force is a mean over a period in which the bristle's damping has no part, whatever the start.
NOT_SETTLED = NOT_BRISTLE | {"initialState", "friction.sigma_1", "time"}
ALL_BUT = {
    "F_t": NOT_FORCE,
    "F_t_mean": NOT_FORCE,
    "delta": NOT_BRISTLE,
    "F_t_settled": NOT_SETTLED,
    "der(delta)": NOT_FORCE,
    "der(W_f)": NOT_FORCE,
    "der(Q_f)": NOT_FORCE,
    "F_y": NOT_BRISTLE,
    "F_y_mean": NOT_BRISTLE,
    "F_y_settled": NOT_SETTLED,
    "delta_y": NOT_BRISTLE,
    "der(delta_y)": NOT_FORCE,
}

# The contact depends on these besides contact.*; the parameters of the stiffness touch neither A_r nor F_n.
CONTACT = {"d", "E", "load", "time", "vibration.f", "vibration.a_d", "vibration.phase_d"}
STIFFNESS = {"contact.model", "contact.sigma", "contact.stiffnessScale"}
ONLY = {"W_f": set(), "Q_f": set(), "body.v": {"body.m", "body.v_0"}, "body.x": {"body.m", "body.x_0"}}


def dependencies(model: ModelDescription) -> dict[str, list[str]]:
    """The names on which each unknown depends, in the order of the file; ValueError if one has no rule."""
    knowns = [
        each.name for each in model.modelVariables if each.causality in ("input", "parameter", "independent")
    ]
    contact = CONTACT | {name for name in knowns if name.startswith("contact.")}
    only = ONLY | {"sigma": contact, "A_r": contact - STIFFNESS, "F_n": contact - STIFFNESS}
    unknowns = {each.variable.name for each in [*model.outputs, *model.derivatives]}
    if unknowns != ALL_BUT.keys() | only.keys():
        strange = ", ".join(sorted(unknowns ^ (ALL_BUT.keys() | only.keys())))
        raise ValueError(f"tools/packing/initial_unknowns.py and ModelStructure differ in {strange}")
    return {
        each.name: [
            name
            for name in knowns
            if (name in only[each.name] if each.name in only else name not in ALL_BUT[each.name])
        ]
        for each in model.modelVariables
        if each.name in unknowns
    }


def section(model: ModelDescription) -> str:
    """The element InitialUnknowns as it stands in the file."""
    index = {each.name: str(k) for k, each in enumerate(model.modelVariables, start=1)}
    rows = (
        f'      <Unknown index="{index[name]}" dependencies="{" ".join(index[each] for each in known)}"/>\n'
        for name, known in dependencies(model).items()
    )
    return f"    <InitialUnknowns>\n{''.join(rows)}    </InitialUnknowns>\n"


def renewed(text: str, model: ModelDescription) -> str:
    """The text of modelDescription.xml with that element; ValueError if it has none."""
    new, count = SECTION.subn(section(model), text)
    if count != 1:
        raise ValueError("modelDescription.xml has no InitialUnknowns on lines of their own")
    return new


def main(xml: Path = description.XML) -> None:
    text = xml.read_text(encoding="utf-8")
    xml.write_text(renewed(text, description.read(xml)), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
