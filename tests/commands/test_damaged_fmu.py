"""A damaged .fmu is refused in one line by whatever reads it, wherever the damage is."""

from __future__ import annotations

from pathlib import Path

import pytest

from frictioncontact.command import main
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification import command as identify
from frictioncontact.sweeps import command as sweep

PLACES = 20


@pytest.mark.parametrize("command", [identify, sweep])
@pytest.mark.parametrize("member", [b"modelDescription.xml", b"FrictionContact.so"])
def test_commands_refuse_it_in_one_line(
    fmu_path: Path, tmp_path: Path, member: bytes, command: object
) -> None:
    """With bytes of a member inverted, so that it can't be decompressed."""
    content, path = fmu_path.read_bytes(), tmp_path / "damaged.fmu"
    place = content.index(member) + 60
    path.write_bytes(
        content[:place] + bytes(b ^ 0xFF for b in content[place : place + 8]) + content[place + 8 :]
    )
    more = ["--vary", "V=0.1,0.2"] if command is sweep else []
    with pytest.raises(SystemExit) as stopped:
        main(command, ["--fmu", str(path), "--output", str(tmp_path / "out"), *more])
    assert str(stopped.value).startswith(f"error: {path}") and "\n" not in str(stopped.value)


def test_damage_anywhere_is_one_error_or_none(fmu_path: Path, tmp_path: Path) -> None:
    """One inverted byte, and the file cut off there. What no reader looks at may be damaged."""
    content, path, refused = fmu_path.read_bytes(), tmp_path / "damaged.fmu", 0
    for k in range(PLACES):
        place = (2 * k + 1) * len(content) // (2 * PLACES)
        inverted = content[:place] + bytes([content[place] ^ 0x55]) + content[place + 1 :]
        for damage in (inverted, content[:place]):
            path.write_bytes(damage)
            try:
                FrictionFmu(path).close()
            except UserError:
                refused += 1
    assert refused > PLACES
