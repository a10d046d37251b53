"""The platforms of a release; cmake/zig.cmake holds how each is compiled, CMakeLists.txt what."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.progress import Progress

from frictioncontact.errors import UserError
from tools.build import build_targets
from tools.zig import environment, zig


@dataclass(frozen=True)
class Platform:
    suffix: str  # of a shared library
    processor: str  # as lief calls it
    tag: str  # of a wheel, by the oldest system that cmake/zig.cmake compiles for
    macos: tuple[int, ...] = ()  # the oldest


# Folders under binaries/, as FMI 2.0.5, section 2.3, and FMI 3.0, section 2.5.1.4.1, name them.
PLATFORMS = {
    "linux64": Platform(".so", "X86_64", "manylinux2014_x86_64"),
    "aarch64-linux": Platform(".so", "AARCH64", "manylinux2014_aarch64"),
    "win64": Platform(".dll", "AMD64", "win_amd64"),
    "darwin64": Platform(".dylib", "X86_64", "macosx_10_15_x86_64", (10, 15)),
    "aarch64-darwin": Platform(".dylib", "ARM64", "macosx_11_0_arm64", (11, 0)),
}


def build(platform: str, targets: Sequence[str], progress: Progress | None = None) -> Path:
    """Builds targets of CMake for a platform, one of PLATFORMS, and gives CMake's folder.

    UserError holds the compiler's first error.
    """
    try:
        return build_targets(platform, targets, progress, [f"-DZIG={zig()}"], environment())
    except UserError as error:
        lines = [line for line in str(error).splitlines() if re.search(r"\berror:", line)]
        raise UserError(f"the build fails: {lines[0]}" if lines else str(error)) from None
