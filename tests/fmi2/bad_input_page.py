"""Makes docs/bad-input.md for the site: what wrong calls get, from the very calls that the tests make."""

from __future__ import annotations

from pathlib import Path

from bad_calls import CALLS, INSTANTIATIONS
from call_table import STATES, TABLE
from fmi_library import CO_SIMULATION, MODEL_EXCHANGE, Instance, Library

from frictioncontact.fmu import FrictionFmu
from tools.build import build_fmu
from tools.project import ROOT

PAGE = ROOT / "docs" / "bad-input.md"
FMI2_ERROR = 3

HEAD = """\
# Wrong calls and values

Each row is a call that a test makes (`tests/fmi2/bad_calls.py`), and the message that reaches the logger in
the category `logStatusError`. Every call returns `fmi2Error`. The state afterwards is the state before, to
the last bit. `scripts/site` makes this page from the FMU.

| call | in state | message |
|---|---|---|
"""

ORDER = """
## Calls out of order

x: allowed. -: `fmi2Error`, with a message such as

    {example}

and nothing changes. A function of one interface is refused everywhere by an instance for the other;
fmi2GetStatus, fmi2GetIntegerStatus and fmi2GetStringStatus are refused even in the states with an x, since no
step is ever pending. Without an instance (NULL) every function returns `fmi2Error` and `fmi2FreeInstance`
does nothing. An instance for co-simulation:

"""

INSTANTIATION = """
## Instantiation

`fmi2Instantiate` gives NULL, with the message

"""


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("%%", "%")


def _table(kind: int) -> list[str]:
    """Functions by states, as a block of code."""
    rows = [["", *STATES[kind]], *([function, *cells] for function, cells in TABLE[kind].items())]
    lines = (f"    {function:35}" + "".join(f"{cell:^22}" for cell in cells) for function, *cells in rows)
    return [line.rstrip() for line in lines]


def _instantiation(library: Library) -> list[str]:
    rows = ["| cause | message |", "|---|---|"]
    for title, (arguments, _) in INSTANTIATIONS.items():
        text = Instance(library, **arguments).last_message.text.replace(library.guid, "{...}")
        rows.append(f"| {title} | {_cell(text)} |")
    return rows


def page(folder: Path) -> str:
    """The text of the page, from the unpacked FMU."""
    library = Library(folder)
    lines = [HEAD.rstrip("\n")]
    for bad in CALLS:
        with Instance(library, kind=bad.kind) as instance:
            bad.setup(instance)
            instance.bring_to(bad.state)
            bad.prepare(instance)
            instance.messages.clear()
            if bad.call(instance) != FMI2_ERROR:
                raise AssertionError(f"{bad.title} is no error")
            lines.append(f"| {_cell(bad.title)} | {bad.state} | {_cell(instance.last_message.text)} |")
    with Instance(library) as instance:
        instance.bring_to("step complete")
        instance.call("fmi2SetupExperiment", 0, 0.0, 0.0, 0, 0.0)
        lines.append(ORDER.rstrip("\n").format(example=instance.last_message.text))
    lines += ["", *_table(CO_SIMULATION), "", "An instance for model exchange:", "", *_table(MODEL_EXCHANGE)]
    lines += [INSTANTIATION.rstrip("\n"), "", *_instantiation(library), ""]
    return "\n".join(lines)


def write_page() -> None:
    with FrictionFmu(build_fmu()) as fmu:
        PAGE.write_text(page(fmu.directory), encoding="utf-8")


if __name__ == "__main__":
    write_page()
