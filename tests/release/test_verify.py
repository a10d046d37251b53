"""scripts/release --check: an FMU of ours passes, and each way to change it is named."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from frictioncontact.errors import UserError
from tools.release.verify import SUMS, verify, write_sums

Entries = dict[str, bytes]
SOURCE = "sources/contact/friction_contact.c"
SUMS_INSIDE = "extra/org.fmi-standard.fmi-ls-ref/sha256sums.txt"


@pytest.fixture
def copy(fmu_path: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(fmu_path, tmp_path / "FrictionContact.fmu"))


def test_the_sums_beside_it_are_compared(copy: Path) -> None:
    *_, beside, results = verify(copy)
    assert beside == f"no {SUMS} lies beside it: the file as a whole is not compared"
    assert results == "12 of 12 results as in the reference"
    write_sums([copy])
    assert f"the file that {SUMS} beside it lists" in verify(copy)
    with zipfile.ZipFile(copy, "a") as archive:
        archive.comment = b"other bytes, same files"
    with pytest.raises(UserError, match=f"is not the file that {SUMS} beside it lists"):
        list(verify(copy))


def replace(entries: Entries, old: bytes, new: bytes) -> None:
    entries["modelDescription.xml"] = entries["modelDescription.xml"].replace(old, new)


CHANGES: dict[str, Callable[[Entries], object]] = {
    "binaries/linux64/other.so was added to it": lambda e: e.update({"binaries/linux64/other.so": b""}),
    "documentation/index.html was taken out of it": lambda e: e.pop("documentation/index.html"),
    f"{SOURCE} was changed": lambda e: e.update({SOURCE: e[SOURCE] + b"\n"}),
    "modelDescription.xml is not the one that its guid": lambda e: replace(e, b'start="55"', b'start="56"'),
    "is none of ours: its model is BouncingBall": lambda e: replace(
        e, b'modelName="FrictionContact"', b'modelName="BouncingBall"'
    ),
    "is no FMU: modelDescription.xml is missing or broken": lambda e: e.pop("modelDescription.xml"),
    "holds no checksums": lambda e: e.pop(SUMS_INSIDE),
}


@pytest.mark.parametrize("message", CHANGES)
def test_a_change_is_named(repacked: Callable[[Callable[[Entries], object]], Path], message: str) -> None:
    with pytest.raises(UserError, match=message):
        list(verify(repacked(CHANGES[message])))


def test_damaged_bytes_are_named(copy: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(copy) as archive:
        place = archive.getinfo(SOURCE).header_offset + 200
    content = bytearray(copy.read_bytes())
    content[place] ^= 0xFF
    copy.write_bytes(content)
    (tmp_path / "text").write_text("text")
    for name, message in ((copy.name, "is damaged"), ("text", "not a zip archive"), (".", "is no file")):
        with pytest.raises(UserError, match=message):
            list(verify(tmp_path / name))
