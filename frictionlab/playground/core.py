"""The FMU as WebAssembly: its own C sources and assets/host.c, compiled by zig, without an import."""

from __future__ import annotations

import tempfile
from pathlib import Path

from frictionlab.release.targets import build


def core() -> bytes:
    """The WebAssembly of the target `playground` of CMake."""
    with tempfile.TemporaryDirectory(prefix="playground-") as temporary:
        build("wasm32-wasi", "playground", Path(temporary))
        return (Path(temporary) / "playground.wasm").read_bytes()
