"""The cross compiler: zig of the package ziglang, for the platforms of a release and for WebAssembly."""

import importlib.util
import os
from pathlib import Path

from frictioncontact.errors import UserError
from tools.project import ROOT


def zig() -> Path:
    """The zig of the ziglang package."""
    found = importlib.util.find_spec("ziglang")
    if found is None or not found.submodule_search_locations:
        raise UserError(
            "the cross compiler is missing: the Python package ziglang of requirements-release.txt is not "
            "installed; scripts/setup release installs it"
        )
    return Path(found.submodule_search_locations[0]) / "zig"


def environment() -> dict[str, str]:
    """This process's, with the place of what zig has compiled; lines of two compilers do not mix."""
    cache = str(ROOT / "build" / "zig-cache")
    zig_cache = {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}
    return {**zig_cache, "MAKEFLAGS": "--output-sync=target", **os.environ}
