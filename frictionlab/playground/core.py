"""The FMU as WebAssembly: its own C sources and assets/host.c, compiled by zig, without an import."""

from __future__ import annotations

import tempfile
from pathlib import Path

import fmpy

from frictionlab.project import ROOT
from frictionlab.release.targets import run_zig

HOST = Path(__file__).with_name("assets") / "host.c"
OPTIONS = (
    "-target", "wasm32-wasi", "-mexec-model=reactor",
    "-std=c11", "-O3", "-DNDEBUG", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-flto",
    "-Wl,--gc-sections", "-Wl,--strip-all", "-Wl,--export-dynamic",
)  # fmt: skip


def core(table: str, cache: Path) -> bytes:
    """The WebAssembly; table is the text of the C variable table."""
    with tempfile.TemporaryDirectory(prefix="playground-") as temporary:
        folder = Path(temporary)
        variables, output = folder / "variables.c", folder / "core.wasm"
        variables.write_text(table)
        sources = [*sorted((ROOT / "fmu_src").rglob("*.c")), variables, HOST]
        includes = [f"-I{ROOT / 'fmu_src'}", "-isystem", str(Path(fmpy.__file__).parent / "c-code")]
        run_zig([*OPTIONS, *includes, *map(str, sources), "-o", str(output)], cache, folder)
        return output.read_bytes()
