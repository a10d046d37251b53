"""Whether an .fmu is one of ours, as it was packed, and gives its reference results: scripts/release --check.

The checksums inside tell an accident or an edit from the file that was packed. They are no signature: who
changes a file on purpose can change its checksum too. SHA256SUMS, published apart, is harder to change.
"""

import hashlib
import re
import subprocess
import sys
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from frictioncontact.errors import UserError
from frictioncontact.files import write_whole
from tools.packing.archive import CHECKSUMS
from tools.packing.model_description import GUID_PLACEHOLDER, guid_of
from tools.project import ROOT

MODEL = "FrictionContact"
SUMS = "SHA256SUMS"  # beside the release: the checksum of each of its files, as sha256sum writes it
REFERENCE_CHECK = ROOT / "examples" / "ci-validation" / "check_reference.py"
SOURCE_FILES = re.compile(
    rb">\s*<SourceFiles>.*?</SourceFiles>\s*</(?:ModelExchange|CoSimulation)>", re.DOTALL
)


def verify(fmu: Path) -> Iterator[str]:
    """One line for each thing that is as it must be; UserError names the first that is not."""
    if not zipfile.is_zipfile(fmu):
        raise UserError(f"{fmu} {'is no FMU: not a zip archive' if fmu.is_file() else 'is no file'}")
    try:
        with zipfile.ZipFile(fmu) as archive:
            entries = {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}
    except (zipfile.BadZipFile, zlib.error) as error:
        raise UserError(f"{fmu} is damaged: {error}") from None
    yield _identity(fmu, entries)
    yield _contents(fmu, entries)
    yield _published(fmu)
    yield _reference(fmu)


def _identity(fmu: Path, entries: dict[str, bytes]) -> str:
    """The guid is a hash of the model description without it and without what packing adds."""
    try:
        root = ElementTree.fromstring(entries.get("modelDescription.xml", b""))
    except ElementTree.ParseError:
        raise UserError(f"{fmu} is no FMU: modelDescription.xml is missing or broken") from None
    if root.get("modelName") != MODEL:
        raise UserError(f"{fmu} is none of ours: its model is {root.get('modelName')}")
    guid = root.get("guid", "")
    before = SOURCE_FILES.sub(b"/>", entries["modelDescription.xml"])
    before = before.replace(f'guid="{guid}"'.encode(), f'guid="{GUID_PLACEHOLDER}"'.encode())
    if guid_of(before) != guid:
        raise UserError(f"{fmu}: modelDescription.xml is not the one that its guid {guid} was made of")
    return f"{MODEL} {root.get('version')}, guid {guid}: the model description is unchanged"


def _contents(fmu: Path, entries: dict[str, bytes]) -> str:
    listed = _read_sums(entries.get(CHECKSUMS, b"").decode())
    if not listed:
        raise UserError(f"{fmu} holds no checksums: {CHECKSUMS} is missing")
    found = {name: hashlib.sha256(content).hexdigest() for name, content in entries.items()}
    del found[CHECKSUMS]
    if different := sorted(listed.items() ^ found.items()):
        name, _ = different[0]
        happened = "taken out of it" if name not in found else "changed" if name in listed else "added to it"
        raise UserError(f"{fmu}: {name} was {happened}")
    return f"{len(found)} files as they were packed"


def _published(fmu: Path) -> str:
    sums = fmu.with_name(SUMS)
    if not sums.is_file():
        return f"no {SUMS} lies beside it: the file as a whole is not compared"
    listed = _read_sums(sums.read_text(encoding="utf-8"))
    if fmu.name not in listed:
        return f"{SUMS} beside it does not list it: the file as a whole is not compared"
    if listed[fmu.name] != hashlib.sha256(fmu.read_bytes()).hexdigest():
        raise UserError(f"{fmu} is not the file that {SUMS} beside it lists")
    return f"the file that {SUMS} beside it lists"


def _reference(fmu: Path) -> str:
    run = subprocess.run([sys.executable, str(REFERENCE_CHECK), str(fmu)], capture_output=True, text=True)
    lines = run.stdout.splitlines()
    if run.returncode:
        missed = [line for line in lines if line.startswith("MISSED")]
        reason = missed[0] if missed else " ".join(run.stderr.split()).removeprefix("error: ")
        raise UserError(f"{fmu}: {reason}")
    return lines[-1]


def _read_sums(text: str) -> dict[str, str]:
    """File name -> checksum, of lines as sha256sum writes them."""
    return {name: checksum for checksum, _, name in (line.partition("  ") for line in text.splitlines())}


def write_sums(files: list[Path]) -> Path:
    """SHA256SUMS beside the files, which share a folder."""
    path = files[0].with_name(SUMS)
    lines = [f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}" for file in files]
    write_whole(path, "\n".join(lines) + "\n")
    return path
