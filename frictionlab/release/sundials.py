"""The part of SUNDIALS that `cvode` needs, as source, for compilers that the distribution has no library for.

The source comes from the distribution's source package, fetched with apt-get into a folder of the build:
neither the system's package lists nor its packages change.
"""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
import tarfile
import tempfile
from dataclasses import dataclass
from pathlib import Path

from frictionlab.release.targets import ReleaseError

FOLDERS = (
    "src/cvode",
    "src/sundials",
    "src/nvector/serial",
    "src/sunmatrix/dense",
    "src/sunmatrix/band",
    "src/sunlinsol/dense",
    "src/sunnonlinsol/newton",
)
LICENSES = ("LICENSE", "NOTICE")
SOURCES = (
    *(f"src/cvode/cvode{part}.c" for part in ("", "_io", "_ls", "_nls", "_proj")),
    *(
        f"src/sundials/sundials_{part}.c"
        for part in (
            *("band", "context", "dense", "direct", "iterative", "linearsolver", "logger", "math", "matrix"),
            *("memory", "nonlinearsolver", "nvector", "nvector_senswrapper", "version"),
        )
    ),
    "src/nvector/serial/nvector_serial.c",
    "src/sunmatrix/dense/sunmatrix_dense.c",
    "src/sunmatrix/band/sunmatrix_band.c",
    "src/sunlinsol/dense/sunlinsol_dense.c",
    "src/sunnonlinsol/newton/sunnonlinsol_newton.c",
)
MAJOR_VERSION = 6  # whose functions cvode_solver.c calls

# What SUNDIALS' own CMake build would write for a plain static build in double precision.
CONFIGURATION = """\
#ifndef SUNDIALS_CONFIG_H
#define SUNDIALS_CONFIG_H
#define SUNDIALS_EXPORT
#define SUNDIALS_DEPRECATED_EXPORT
#define SUNDIALS_DEPRECATED_MSG(message)
#define SUNDIALS_DEPRECATED_EXPORT_MSG(message)
#define SUNDIALS_VERSION "{major}.{minor}.{patch}"
#define SUNDIALS_VERSION_MAJOR {major}
#define SUNDIALS_VERSION_MINOR {minor}
#define SUNDIALS_VERSION_PATCH {patch}
#define SUNDIALS_VERSION_LABEL ""
#define SUNDIALS_GIT_VERSION ""
#define SUNDIALS_C_COMPILER_HAS_MATH_PRECISIONS
#define SUNDIALS_C_COMPILER_HAS_ISINF_ISNAN
#define SUNDIALS_C_COMPILER_HAS_INLINE
#define SUNDIALS_C_COMPILER_HAS_SNPRINTF_AND_VA_COPY
#define SUNDIALS_DOUBLE_PRECISION 1
#define SUNDIALS_INT64_T 1
#define SUNDIALS_INDEX_TYPE int64_t
#define SUNDIALS_LOGGING_LEVEL 0
#define SUNDIALS_MPI_ENABLED 0
#define SUNDIALS_INLINE inline
#define SUNDIALS_STATIC_INLINE static inline
#endif
"""


@dataclass(frozen=True)
class SundialsSource:
    """An unpacked source of SUNDIALS with its sundials_config.h."""

    folder: Path
    version: str
    sha256: str  # of the archive that it was unpacked from

    @property
    def sources(self) -> list[Path]:
        return [self.folder / name for name in SOURCES]

    @property
    def includes(self) -> list[Path]:
        return [self.folder / "include", self.folder / "src" / "sundials"]


def fetched(folder: Path) -> SundialsSource:
    """The source in folder, fetched if it is not there yet."""
    if not (folder / "archive.sha256").is_file():
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent, prefix="sundials-") as temporary:
            archive = _download(Path(temporary))
            unpacked = _unpack(archive, Path(temporary) / "unpacked")
            if folder.exists():
                shutil.rmtree(folder)
            unpacked.rename(folder)
    missing = [name for name in (*SOURCES, *LICENSES) if not (folder / name).is_file()]
    if missing:
        raise ReleaseError(f"SUNDIALS in {folder} is incomplete, {missing[0]} is missing: remove that folder")
    header = (folder / "include/sundials/sundials_config.h").read_text()
    version = re.search(r'SUNDIALS_VERSION "([\d.]+)"', header)
    return SundialsSource(
        folder, version[1] if version else "unknown", (folder / "archive.sha256").read_text().strip()
    )


def _download(folder: Path) -> Path:
    """The .orig.tar of the source package sundials."""
    if shutil.which("apt-get") is None:
        raise ReleaseError(
            "SUNDIALS' source can't be fetched: apt-get is missing (a release is made on Debian or Ubuntu)"
        )
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
        raise ReleaseError(f"SUNDIALS' source can't be fetched (apt-get source sundials: {why[:300]})")
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
    """The folders that CVODE needs, with the configuration header and the checksum of the archive."""
    with tarfile.open(archive) as packed:
        for member in packed:
            name = member.name.partition("/")[2]
            wanted = name in LICENSES or name == "CMakeLists.txt" or name.startswith("include/")
            wanted |= name.rpartition("/")[0] in FOLDERS
            content = packed.extractfile(member) if wanted and member.isfile() else None
            if content is not None:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_bytes(content.read())
    build = (folder / "CMakeLists.txt").read_text() if (folder / "CMakeLists.txt").is_file() else ""
    numbers = {
        part.lower(): match[1]
        for part in ("MAJOR", "MINOR", "PATCH")
        if (match := re.search(rf'(?i)set\(PACKAGE_VERSION_{part} "(\d+)"\)', build))
    }
    if numbers.get("major") != str(MAJOR_VERSION):
        raise ReleaseError(
            f"{archive.name} is not SUNDIALS {MAJOR_VERSION}, which the FMU's cvode is written for"
        )
    (folder / "include/sundials/sundials_config.h").write_text(CONFIGURATION.format(**numbers))
    (folder / "archive.sha256").write_text(hashlib.sha256(archive.read_bytes()).hexdigest() + "\n")
    return folder
