"""A damaged .fmu is refused in one line by whatever reads it, wherever the damage is."""

from __future__ import annotations

from pathlib import Path

import pytest
from frictioncontact.batch.unpacked import description_and_library

from frictioncontact.batch import simulate_many
from frictioncontact.command import main
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.identification import command as identify
from frictioncontact.sweeps import command as sweep
from workshop.validate import command as validate

PLACES = 30


@pytest.fixture(params=[b"modelDescription.xml", b"FrictionContact.so"], ids=["description", "library"])
def damaged(fmu_path: Path, tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """With bytes of a member inverted, so that it can't be decompressed."""
    content = fmu_path.read_bytes()
    place = content.index(request.param) + 60
    path = tmp_path / "damaged.fmu"
    inverted = bytes(byte ^ 0xFF for byte in content[place : place + 8])
    path.write_bytes(content[:place] + inverted + content[place + 8 :])
    return path


@pytest.mark.parametrize("command", [identify, sweep, validate])
def test_commands_refuse_it_in_one_line(
    damaged: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], command: object
) -> None:
    more = ["--vary", "V=0.1,0.2"] if command is sweep else []
    with pytest.raises(SystemExit) as stopped:
        main(command, ["--fmu", str(damaged), "--output", str(tmp_path / "out"), *more])
    message = str(stopped.value)
    assert message.startswith("error: ")
    assert str(damaged) in message
    assert "\n" not in message
    assert capsys.readouterr().err == ""


def test_simulate_many_refuses_it(damaged: Path) -> None:
    with pytest.raises(UserError, match=r"damaged\.fmu: "):
        simulate_many({"V": 0.1}, fmu=damaged)


def test_damage_anywhere_is_one_error_or_none(fmu_path: Path, tmp_path: Path) -> None:
    """One inverted byte, and the file cut off there. What no reader looks at may be damaged."""
    content = fmu_path.read_bytes()
    refused = 0
    for k in range(PLACES):
        place = (2 * k + 1) * len(content) // (2 * PLACES)
        for damage in (
            content[:place] + bytes([content[place] ^ 0x55]) + content[place + 1 :],
            content[:place],
        ):
            path = tmp_path / "damaged.fmu"
            path.write_bytes(damage)
            try:
                FrictionFmu(path).close()
            except UserError:
                refused += 1
            try:
                description_and_library(damage, "the FMU")
            except UserError:
                refused += 1
    assert refused > 2 * PLACES
