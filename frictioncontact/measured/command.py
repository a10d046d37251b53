"""Lists the measured contacts, or says all of one."""

import argparse
from collections.abc import Sequence

from frictioncontact.command import command_line
from frictioncontact.measured.contacts import contacts

DESCRIPTION = """\
Contacts that were measured: without a name the list, with one its start values, where they hold, how
uncertain they are, and their source.

  %(prog)s steel-dry"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact contacts", DESCRIPTION)
    parser.add_argument("name", nargs="?", help="of a contact")
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    print(contacts()[options.name] if options.name else contacts())
