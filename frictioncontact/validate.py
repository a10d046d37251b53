"""Holds the measured contacts against the means that they were fitted to."""

import argparse
from collections.abc import Sequence

import numpy as np
import pandas as pd

from frictioncontact.batch import simulate_many
from frictioncontact.command import add_fmu, command_line, print_frame
from frictioncontact.errors import quiet
from frictioncontact.fmu import opened
from frictioncontact.identification.data import read
from frictioncontact.measured import contacts

DESCRIPTION = """\
Holds the measured contacts against the means that they were fitted to: measured, by the FMU, the difference.
The documentation's page on validation holds every law against every measurement."""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact validate", DESCRIPTION)
    add_fmu(parser)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    for contact in filter(lambda contact: contact.data, contacts().values()):
        rows = read(contact.data, opened(options.fmu), {})
        scenes = pd.DataFrame([{**contact.start, **conditions} for conditions in rows.conditions])
        with quiet():
            found = simulate_many(scenes, ["F_t_settled"], fmu=options.fmu)["F_t_settled"].to_numpy()
        miss = found - rows.force
        table = scenes[list(rows.names)].assign(measured=rows.force, FMU=found, difference=miss)
        print(f"{contact.name}: {contact.title}, mean friction")
        print_frame(table, opened(options.fmu).known, contact.start, measured="N", FMU="N", difference="N")
        print(f"misfit: {np.sqrt(np.mean(miss**2)):.3f} N (rms)")
