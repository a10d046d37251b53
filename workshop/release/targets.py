"""The platforms of a release; cmake/zig.cmake holds how each is compiled, CMakeLists.txt what."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

from frictioncontact.errors import UserError
from workshop.project import ROOT

# Folders under binaries/, as FMI 2.0.5, section 2.3, and FMI 3.0, section 2.5.1.4.1, name them.
SUFFIXES = {
    "linux64": ".so",
    "aarch64-linux": ".so",
    "win64": ".dll",
    "darwin64": ".dylib",
    "aarch64-darwin": ".dylib",
}
CACHE = ROOT / "build" / "zig-cache"
CMAKE_ERROR = re.compile(r"CMake Error at [^\n]*:\n(.*?)(?:Call Stack|-- Configuring|\Z)", re.DOTALL)


def zig() -> Path:
    """The zig of the ziglang package."""
    found = importlib.util.find_spec("ziglang")
    if found is None or not found.submodule_search_locations:
        raise UserError(
            "the cross compiler is missing: the Python package ziglang of requirements-release.txt is not "
            "installed; scripts/setup release installs it"
        )
    folder = Path(found.submodule_search_locations[0])
    for name in ("zig", "zig.exe"):
        if (folder / name).is_file():
            return folder / name
    raise UserError(f"the cross compiler is missing: no zig in the package ziglang, {folder}")


def build(platform: str, target: str, folder: Path, cache: Path = CACHE, root: Path = ROOT) -> None:
    """Builds a target of CMake for a platform in folder, which is made if it is new.

    root holds the sources. platform: one of SUFFIXES. UserError holds the first error.
    """
    if not (folder / "Makefile").is_file():
        options = {
            "CMAKE_TOOLCHAIN_FILE": root / "cmake" / "zig.cmake",
            "CMAKE_BUILD_TYPE": "Release",
            "FMI_PLATFORM": platform,
            "FC_SUNDIALS_SOURCE": ROOT / "build" / "sundials-source",
            "Python3_EXECUTABLE": sys.executable,
            "ZIG": zig(),
        }
        defined = [f"-D{name}={value}" for name, value in options.items()]
        _cmake(["-S", str(root), "-B", str(folder), "-G", "Unix Makefiles", *defined], cache)
    jobs = str(os.cpu_count() or 1)
    _cmake(["--build", str(folder), "--target", target, "--parallel", jobs], cache)


def _cmake(arguments: list[str], cache: Path) -> None:
    environment = {**os.environ, "ZIG_GLOBAL_CACHE_DIR": str(cache), "ZIG_LOCAL_CACHE_DIR": str(cache)}
    command = [sys.executable, "-m", "cmake", *arguments]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, errors="replace")
    if run.returncode:
        if match := CMAKE_ERROR.search(run.stderr):
            raise UserError(" ".join(match[1].split()))
        lines = run.stderr.splitlines()
        errors = [line for line in lines if re.search(r"\berror:", line)] or lines
        raise UserError(f"the build fails: {errors[0] if errors else f'exit status {run.returncode}'}")
