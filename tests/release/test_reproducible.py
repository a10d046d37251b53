"""The same sources give the same bytes, wherever they lie and whatever the compiler has kept of them."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tools.project import ROOT
from tools.zig import environment, zig

PLATFORM = (
    "aarch64-darwin"  # whose libraries hold most besides code: a signature, and the place they were made in
)


@pytest.mark.slow
def test_another_folder_and_an_empty_cache(
    library: Callable[[str], Path], copy_project: Callable[[Path], Path], tmp_path: Path
) -> None:
    elsewhere = copy_project(tmp_path / "another name" / "checkout")
    cmake = [sys.executable, "-m", "cmake"]
    settings = {
        "Python3_EXECUTABLE": sys.executable,
        "ZIG": zig(),
        "FC_SUNDIALS_SOURCE": ROOT / "build" / "sundials-source",
    }
    configure = ["--preset", PLATFORM, *(f"-D{name}={value}" for name, value in settings.items())]
    build = ["--build", f"build/{PLATFORM}", "--target", "FrictionContact", "--parallel", str(os.cpu_count())]
    empty = {"ZIG_LOCAL_CACHE_DIR": str(tmp_path / "cache")}  # the other one has the compiler's own library
    for arguments in (configure, build):
        subprocess.run([*cmake, *arguments], cwd=elsewhere, env=environment() | empty, check=True)
    again = elsewhere / "build" / PLATFORM / "FrictionContact.dylib"
    assert again.read_bytes() == library(PLATFORM).read_bytes()
