"""A damaged .fmu is refused in one line by whatever reads it, wherever the damage is."""

from __future__ import annotations

from pathlib import Path

import pytest

from frictioncontact.command import main
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.sweeps import run as sweep

PLACES = 20


@pytest.mark.parametrize("member", [b"modelDescription.xml", b"FrictionContact.so"])
def test_a_command_refuses_it_in_one_line(fmu_path: Path, tmp_path: Path, member: bytes) -> None:
    """With bytes of a member inverted, so that it can't be decompressed."""
    content, path = fmu_path.read_bytes(), tmp_path / "damaged.fmu"
    place = content.index(member) + 60
    inverted = bytes(byte ^ 0xFF for byte in content[place : place + 8])
    path.write_bytes(content[:place] + inverted + content[place + 8 :])
    with pytest.raises(SystemExit, match=f"^error: {path}[^\n]*$"):
        main(sweep, ["--fmu", str(path), "--output", str(tmp_path / "out"), "--vary", "V=0.1,0.2"])


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
