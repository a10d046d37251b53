"""Fetches the part of SUNDIALS' source that `cvode` and bench/ need, from the distribution's source package.

usage: fetch_sundials.py FOLDER

FOLDER appears when it is complete; archive.sha256 in it holds the checksum of the archive it came from.
Neither the system's package lists nor its packages change.
"""

from __future__ import annotations

import contextlib
import hashlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

FOLDERS = (
    "src/cvode",
    "src/sundials",
    "src/nvector/serial",
    "src/sunmatrix/dense",
    "src/sunmatrix/band",
    "src/sunlinsol/dense",
    "src/sunnonlinsol/newton",
)
FILES = ("CMakeLists.txt", "LICENSE", "NOTICE")


class FetchError(Exception):
    """The source can't be had; the text is one line that says why."""


def fetch(folder: Path) -> None:
    """Fills folder; where another process was faster, its folder stays."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f"{folder.name}-") as temporary:
        archive = _download(Path(temporary))
        unpacked = _unpack(archive, Path(temporary) / "unpacked")
        with contextlib.suppress(OSError):
            unpacked.rename(folder)
    if not (folder / "archive.sha256").is_file():
        raise FetchError(f"{folder} is in the way: remove it")


def _download(folder: Path) -> Path:
    """The .orig.tar of the source package sundials."""
    if shutil.which("apt-get") is None:
        raise FetchError("apt-get is missing")
    lists, entries = folder / "lists", folder / "entries"
    (lists / "partial").mkdir(parents=True)
    entries.mkdir()
    _write_source_entries(entries)
    apt_get = [
        *("apt-get", "-qq", "-o", "APT::Sandbox::User=root", "-o", "Dir::Etc::SourceList=/dev/null"),
        *("-o", f"Dir::Etc::SourceParts={entries}", "-o", f"Dir::State::Lists={lists}"),
        *("-o", f"Dir::Cache={folder}"),
    ]
    # The update may fail for entries that have no sources; what counts is whether the package is found.
    update = subprocess.run([*apt_get, "update"], capture_output=True, text=True)
    source = subprocess.run(
        [*apt_get, "source", "--download-only", "sundials"], cwd=folder, capture_output=True, text=True
    )
    archives = sorted(folder.glob("sundials_*.orig.tar.*z*"))
    if source.returncode or not archives:
        why = " ".join((update.stderr + source.stderr).split()) or "no archive came"
        raise FetchError(f"apt-get source sundials: {why[:300]}")
    return archives[0]


def _write_source_entries(folder: Path) -> None:
    """The system's package sources, as entries for source packages."""
    system = Path("/etc/apt")
    for path in [system / "sources.list", *sorted((system / "sources.list.d").glob("*"))]:
        if not path.is_file():
            continue
        text = path.read_text()
        if path.suffix == ".sources":
            text = re.sub(r"(?m)^Types:.*$", "Types: deb-src", text)
        else:
            text = re.sub(r"(?m)^deb ", "deb-src ", text)
        (folder / path.name).write_text(text)


def _unpack(archive: Path, folder: Path) -> Path:
    """The folders that are needed, with the checksum of the archive."""
    with tarfile.open(archive) as packed:
        for member in packed:
            name = member.name.partition("/")[2]
            wanted = name in FILES or name.startswith("include/") or name.rpartition("/")[0] in FOLDERS
            content = packed.extractfile(member) if wanted and member.isfile() else None
            if content is not None:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_bytes(content.read())
    (folder / "archive.sha256").write_text(hashlib.sha256(archive.read_bytes()).hexdigest() + "\n")
    return folder


if __name__ == "__main__":
    try:
        fetch(Path(sys.argv[1]))
    except (FetchError, OSError) as error:
        sys.exit(str(error))
