"""The page from its parts: one HTML file that loads nothing, with the FMU in it as WebAssembly.

The WebAssembly is made of the FMU's own C sources and assets/host.c by zig, all files in one call with
-flto: built by CMake, from archives and with -flto=thin, it imported seven functions of a system, and a page
has none.
"""

import base64
import hashlib
import json
import re
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import fmpy

from frictioncontact.errors import UserError
from frictioncontact.files import whole_file
from frictioncontact.plausibility import USED
from tools.description import XML, description
from tools.packing import model_description, variable_table
from tools.presets import presets
from tools.project import ROOT
from tools.zig import environment, zig

ASSETS = Path(__file__).with_name("assets")
PLACE = re.compile(r"/\*\[([\w.]+)\]\*/|<!--\[(\w+)\]-->")
OPTIONS = (
    "-target", "wasm32-wasi", "-mexec-model=reactor",
    "-std=c11", "-Os", "-DNDEBUG", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-flto",
    "-Wl,--gc-sections", "-Wl,--strip-all", "-Wl,--export-dynamic",
)  # fmt: skip


def page_text() -> str:
    """The page of this FMU; UserError says why it can't be compiled."""
    model = description()
    scenes = [{key: v for key, v in asdict(preset).items() if v is not None} for preset in presets()]
    parts = {"version": model["version"], "wasm": base64.b64encode(core()).decode()}
    parts |= {"description": _json(model), "presets": _json(scenes)}
    parts["controls"] = _json(controls(model["variables"]))

    def part(match: re.Match[str]) -> str:
        asset, name = match.groups()
        return (ASSETS / asset).read_text(encoding="utf-8").strip() if asset else parts[name]

    return PLACE.sub(part, (ASSETS / "page.html").read_text(encoding="utf-8"))


def _json(value: object) -> str:
    """JSON that can stand in a script element."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")


def controls(variables: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Those of controls.json, and a plain one for any other variable that can change at every time.

    Each shows where its variable is used.
    """
    found = json.loads((ASSETS / "controls.json").read_text(encoding="utf-8"))
    known = {spec["name"] for spec in found}
    for each in variables:
        name, start = each["name"], each["start"]
        can_change = each["causality"] == "input" or each["variability"] == "tunable"
        if name not in known and can_change and not name.startswith("body."):  # the page has no mass
            group, _, words = name.rpartition(".")
            span = {"low": 1e-3 * (start or 1.0), "high": 1e3 * (start or 1.0), "off": not start}
            look = {"group": group.title() or "Other", "symbol": "", "words": words, "scale": "log"}
            found.append({"name": name, **look, **span})
    where = {name: {decider: items} for name, decider, items in USED if items}
    return [{"when": where.get(spec["name"], {}), **spec} for spec in found]


def core() -> bytes:
    """The WebAssembly, compiled once for the same sources; UserError holds the compiler's first error."""
    compiler, table = zig(), variable_table.table(model_description.read(XML))
    sources = [*sorted((ROOT / "fmu_src").rglob("*.c")), ASSETS / "host.c"]
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
