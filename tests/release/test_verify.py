"""scripts/release --check: an FMU of ours passes, and each way to change it is named."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from frictioncontact.errors import UserError
from workshop.release.verify import SUMS, verify, write_sums

Entries = dict[str, bytes]
SOURCE = "sources/friction_contact.c"
SUMS_INSIDE = "extra/org.fmi-standard.fmi-ls-ref/sha256sums.txt"


@pytest.fixture
def copy(fmu_path: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(fmu_path, tmp_path / "FrictionContact.fmu"))


def repack(fmu: Path, change: Callable[[Entries], None]) -> None:
    with zipfile.ZipFile(fmu) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    change(entries)
    with zipfile.ZipFile(fmu, "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, content)


def test_an_fmu_of_ours_passes(copy: Path) -> None:
    lines = list(verify(copy))
    assert len(lines) == 4
    assert lines[0].startswith("FrictionContact ") and lines[0].endswith("the model description is unchanged")
    assert lines[1].endswith("files as they were packed")
    assert lines[2] == f"no {SUMS} lies beside it: the file as a whole is not compared"
    assert lines[3].endswith("results as in the reference")


def test_the_sums_beside_it_are_compared(copy: Path) -> None:
    write_sums([copy])
    assert list(verify(copy))[2] == f"the file that {SUMS} beside it lists"
    write_sums([copy])
    with zipfile.ZipFile(copy, "a") as archive:
        archive.comment = b"other bytes, same files"
    with pytest.raises(UserError, match=f"is not the file that {SUMS} beside it lists"):
        list(verify(copy))


def add(entries: Entries) -> None:
    entries["binaries/linux64/other.so"] = b""


def take_out(entries: Entries) -> None:
    del entries["documentation/index.html"]


def edit_source(entries: Entries) -> None:
    entries[SOURCE] += b"\n"


def edit_description(entries: Entries) -> None:
    entries["modelDescription.xml"] = entries["modelDescription.xml"].replace(b'start="55"', b'start="56"')


def rename(entries: Entries) -> None:
    entries["modelDescription.xml"] = entries["modelDescription.xml"].replace(
        b'modelName="FrictionContact"', b'modelName="BouncingBall"'
    )


def drop_description(entries: Entries) -> None:
    del entries["modelDescription.xml"]


def drop_sums(entries: Entries) -> None:
    del entries[SUMS_INSIDE]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (add, "binaries/linux64/other.so was added to it"),
        (take_out, "documentation/index.html was taken out of it"),
        (edit_source, f"{SOURCE} was changed"),
        (edit_description, "modelDescription.xml is not the one that its guid"),
        (rename, "is none of ours: its model is BouncingBall"),
        (drop_description, "is no FMU: modelDescription.xml is missing or broken"),
        (drop_sums, "holds no checksums"),
    ],
)
def test_a_change_is_named(copy: Path, change: Callable[[Entries], None], message: str) -> None:
    repack(copy, change)
    with pytest.raises(UserError, match=message):
        list(verify(copy))


def test_damaged_bytes_are_named(copy: Path) -> None:
    with zipfile.ZipFile(copy) as archive:
        place = archive.getinfo(SOURCE).header_offset + 200
    content = bytearray(copy.read_bytes())
    content[place] ^= 0xFF
    copy.write_bytes(content)
    with pytest.raises(UserError, match="is damaged"):
        list(verify(copy))


def test_what_is_no_fmu_is_named(tmp_path: Path) -> None:
    (tmp_path / "text").write_text("text")
    for name, message in (
        ("text", "is no FMU: not a zip archive"),
        ("none", "is no file"),
        (".", "is no file"),
    ):
        with pytest.raises(UserError, match=message):
            list(verify(tmp_path / name))
