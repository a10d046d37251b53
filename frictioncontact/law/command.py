"""The friction law of a contact as a table, a CSV file or a picture."""

import argparse
from collections.abc import Sequence

import numpy as np
import pandas as pd

from frictioncontact.command import (
    add_fmu,
    add_set,
    can_draw,
    command_line,
    new_file,
    print_frame,
    say_written,
)
from frictioncontact.errors import UserError
from frictioncontact.files import write_whole
from frictioncontact.fmu import opened
from frictioncontact.law.law import FORCE, TRANSVERSE, friction_law
from frictioncontact.sweeps.scenarios import grid
from frictioncontact.values import assignments

DESCRIPTION = """\
The friction law that a machine sees which is slower than the vibration: the mean force over a period, once
settled, and its derivative by V, at every combination of the values that --vary gives to inputs. With motion
transverse to V the mean transverse force is there, too. All values are in SI units; the headings of a CSV
file are the names alone.

  %(prog)s --set vibration.V_1=1.44 --set contact.stiffnessScale=4.4e-7
  %(prog)s --set vibration.V_1=1.44 --vary V=0.01:2:50:log --vary E=40e9,58e9 --output law.csv
  %(prog)s --set vibration.V_1=1.44 --vary V=0:2:200 --picture law.png"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact law", DESCRIPTION)
    add_set(parser, "of the scene")
    parser.add_argument(
        "--vary", action="append", default=[], metavar="NAME=VALUES",
        help="a,b,c or low:high:count[:log] of an input",
    )  # fmt: skip
    parser.add_argument("--output", type=new_file, metavar="CSV", help="write the table there")
    parser.add_argument(
        "--picture", type=new_file, metavar="PNG", help="draw the law over V there (.png, .svg, .pdf)"
    )
    add_fmu(parser)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    if options.picture and options.picture.suffix not in (".png", ".svg", ".pdf"):
        raise UserError(f"--picture {options.picture}: must end in .png, .svg or .pdf")
    known = opened(options.fmu).known
    scene = known.assigned(options.set)
    law = friction_law(scene, fmu=options.fmu)
    vary = assignments(options.vary, "--vary")
    for name in vary:
        known.find(name, "--vary", ("input",))
    if "V" in scene and "V" not in vary:
        vary["V"] = str(scene["V"])
    elif "V" not in vary:
        amplitude = max(float(law.start.get(f"vibration.{name}", 0.0)) for name in ("V_1", "V_2"))
        vary["V"] = f"0:{1.5 * amplitude or 0.1}:16"
    made = grid(known, vary)
    inputs = made.rows(0, made.count)
    V = inputs.pop("V")
    table = pd.DataFrame({"V": V, **inputs, FORCE: law(V, **inputs), "d/dV": law.derivative(V, **inputs)})
    if {"V_y", "vibration.V_2", "delta_y_0"} & {*inputs, *law.start}:
        table[TRANSVERSE] = law.transverse(V, **inputs)
    if options.output:
        write_whole(options.output, table.to_csv(index=False))
    else:
        print_frame(table, known, scene, **{"d/dV": "N s/m"})
    if options.picture and can_draw():
        from frictioncontact import style

        for name, values in inputs.items():
            if len(np.unique(values)) > 1:
                raise UserError(f"--picture draws the law over V alone: give one value of {name}")
        held = {name: float(values[0]) for name, values in inputs.items()}
        style.save(law.plot(np.unique(V), **held), options.picture)
    say_written([path for path in (options.output, options.picture) if path])
