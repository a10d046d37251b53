"""The FMU as WebAssembly: its own C sources and assets/host.c, compiled by zig, without an import.

All files in one call with -flto: built by CMake, from archives and with -flto=thin, the module imported seven
functions of a system, and a page has none.
"""

import hashlib
import subprocess
import tempfile
from importlib.metadata import version
from pathlib import Path

import fmpy

from frictioncontact.errors import UserError
from frictioncontact.files import whole_file
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
    """The WebAssembly, compiled once for the same sources; UserError holds the compiler's first error."""
    compiler = zig()
    table = variable_table.table(model_description.read(ROOT / "modelDescription.xml"))
    sources = [*sorted((ROOT / "fmu_src").rglob("*.c")), HOST]
    headers = sorted((ROOT / "fmu_src").rglob("*.h"))
    parts = [repr((OPTIONS, version("ziglang"), version("fmpy"))).encode(), table.encode()]
    parts += [path.read_bytes() for path in (*sources, *headers)]
    digest = hashlib.sha256(b"\0".join(parts)).hexdigest()
    made = ROOT / "build" / "playground" / f"{digest}.wasm"
    if not made.exists():
        with tempfile.TemporaryDirectory(prefix="playground-") as temporary, whole_file(made) as output:
            variables = Path(temporary) / "variables.c"
            variables.write_text(table, encoding="utf-8")
            includes = [f"-I{ROOT / 'fmu_src'}", "-isystem", str(Path(fmpy.__file__).parent / "c-code")]
            files = map(str, [*sources, variables, "-o", output])
            _compile([str(compiler), "cc", *OPTIONS, *includes, *files])
    return made.read_bytes()


def _compile(command: list[str]) -> None:
    run = subprocess.run(command, env=environment(), capture_output=True, text=True, errors="replace")
    if run.returncode:
        lines = run.stderr.splitlines()
        errors = [line for line in lines if "error" in line] or lines
        raise UserError(f"zig cc fails: {errors[0] if errors else f'exit status {run.returncode}'}")
