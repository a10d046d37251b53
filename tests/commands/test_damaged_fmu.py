"""A damaged .fmu is refused in one line by whatever reads it, wherever the damage is."""

from __future__ import annotations

from pathlib import Path

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu

PLACES = 20


def test_damage_anywhere_is_one_error_or_none(fmu_path: Path, tmp_path: Path) -> None:
    """One inverted byte, and the file cut off there. What no reader looks at may be damaged."""
    content, path, refused = fmu_path.read_bytes(), tmp_path / "damaged.fmu", list[str]()
    for k in range(PLACES):
        place = (2 * k + 1) * len(content) // (2 * PLACES)
        inverted = content[:place] + bytes([content[place] ^ 0x55]) + content[place + 1 :]
        for damage in (inverted, content[:place]):
            path.write_bytes(damage)
            try:
                FrictionFmu(path).close()
            except UserError as error:
                refused.append(str(error))
    assert len(refused) > PLACES
    assert all(said.startswith(str(path)) and "\n" not in said for said in refused)
