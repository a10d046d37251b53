"""The platforms of a release, and how each one's library is compiled and linked with zig.

Folder names as in FMI 2.0.5, section 2.3: linux64, win64, darwin64 mean x86-64; every other platform has the
platform tuple of FMI 3.0, section 2.5.1.4.1.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

IDENTIFIER = "FrictionContact"

# Contraction is off and fast math never on: every platform computes the same numbers.
COMPILE = (
    "-std=c11",
    "-O3",
    "-DNDEBUG",
    "-ffp-contract=off",
    "-fvisibility=hidden",
    "-ffunction-sections",
    "-fdata-sections",
)
LINUX = ("-flto", "-Wl,-z,defs", "-Wl,--gc-sections", f"-Wl,-soname,{IDENTIFIER}.so", "-lm")
MACOS = ("-Wl,-dead_strip", f"-Wl,-install_name,@rpath/{IDENTIFIER}.dylib")


class ReleaseError(Exception):
    """The release can't be made; the text is one line that says why."""


@dataclass(frozen=True)
class Target:
    """One platform of the FMU."""

    platform: str  # folder under binaries/
    triple: str  # as zig takes it
    suffix: str
    link: tuple[str, ...]  # and -flto, which zig's linkers for the other formats do not take


TARGETS = {
    target.platform: target
    for target in (
        Target("linux64", "x86_64-linux-gnu.2.17", ".so", LINUX),
        Target("aarch64-linux", "aarch64-linux-gnu.2.17", ".so", LINUX),
        Target("win64", "x86_64-windows-gnu", ".dll", ()),
        Target("darwin64", "x86_64-macos.10.15", ".dylib", MACOS),
        Target("aarch64-darwin", "aarch64-macos.11.0", ".dylib", MACOS),
    )
}


def zig() -> Path:
    """The zig of the ziglang package."""
    found = importlib.util.find_spec("ziglang")
    if found is None or not found.submodule_search_locations:
        raise ReleaseError(
            "the cross compiler is missing: the Python package ziglang of requirements-release.txt is not "
            "installed; scripts/setup release installs it"
        )
    folder = Path(found.submodule_search_locations[0])
    for name in ("zig", "zig.exe"):
        if (folder / name).is_file():
            return folder / name
    raise ReleaseError(f"the cross compiler is missing: no zig in the package ziglang, {folder}")


def run_zig(arguments: list[str], cache: Path, folder: Path) -> None:
    """Runs zig cc in a folder; ReleaseError holds the first error it gives."""
    environment = {**os.environ, "ZIG_GLOBAL_CACHE_DIR": str(cache), "ZIG_LOCAL_CACHE_DIR": str(cache)}
    command = [str(zig()), "cc", *arguments]
    run = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, errors="replace"
    )
    if run.returncode:
        lines = [line for line in run.stderr.splitlines() if "error" in line] or run.stderr.splitlines()
        raise ReleaseError(f"zig cc fails: {lines[0] if lines else f'exit status {run.returncode}'}")


def compile_library(
    target: Target, sources: list[Path], includes: list[Path], exports: Path, cache: Path, folder: Path
) -> Path:
    """folder/FrictionContact.so and its like, stripped, exporting the fmi2 functions only.

    exports: the linker's version script, for ELF; the other formats export what the FMI headers declare so.
    """
    library = folder / f"{IDENTIFIER}{target.suffix}"
    version_script = [f"-Wl,--version-script={exports}"] if target.suffix == ".so" else []
    run_zig(
        [
            *("-target", target.triple, *COMPILE, "-w", "-DFC_WITH_SUNDIALS"),
            *(f"-I{include}" for include in includes),
            *(str(source) for source in sources),
            *("-shared", "-s", "-o", library.name, *version_script, *target.link),
        ],
        cache,
        folder,
    )
    return library
