"""The FMU as WebAssembly: its own C sources and assets/host.c, compiled by zig, without an import.

All files in one call with -flto: built by CMake, from archives and with -flto=thin, the module imported seven
functions of a system, and a page has none.
"""

import subprocess
import tempfile
from pathlib import Path

import fmpy

from frictioncontact.errors import UserError
from workshop.packing import model_description, variable_table
from workshop.project import ROOT
from workshop.release.targets import environment, zig

HOST = Path(__file__).with_name("assets") / "host.c"
OPTIONS = (
    "-target", "wasm32-wasi", "-mexec-model=reactor",
    "-std=c11", "-Os", "-DNDEBUG", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-flto",
    "-Wl,--gc-sections", "-Wl,--strip-all", "-Wl,--export-dynamic",
)  # fmt: skip


def core() -> bytes:
    """The WebAssembly; UserError holds the compiler's first error."""
    with tempfile.TemporaryDirectory(prefix="playground-") as temporary:
        variables, output = Path(temporary) / "variables.c", Path(temporary) / "core.wasm"
        description = model_description.read(ROOT / "modelDescription.xml")
        variables.write_text(variable_table.table(description), encoding="utf-8")
        sources = [*sorted((ROOT / "fmu_src").rglob("*.c")), variables, HOST]
        includes = [f"-I{ROOT / 'fmu_src'}", "-isystem", str(Path(fmpy.__file__).parent / "c-code")]
        _compile([*OPTIONS, *includes, *map(str, sources), "-o", str(output)])
        return output.read_bytes()


def _compile(arguments: list[str]) -> None:
    run = subprocess.run(
        [str(zig()), "cc", *arguments], env=environment(), capture_output=True, text=True, errors="replace"
    )
    if run.returncode:
        lines = run.stderr.splitlines()
        errors = [line for line in lines if "error" in line] or lines
        raise UserError(f"zig cc fails: {errors[0] if errors else f'exit status {run.returncode}'}")
