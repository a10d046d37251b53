"""Lines of the documents that start programs: quick ones run, the programs read the options of the others."""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

import pages
import pytest

from tools.build import build_targets
from tools.project import ROOT

BIN = Path(sys.executable).parent
PATH = f"{BIN}:{os.environ['PATH']}"
ELSEWHERE = {  # where else a program is started, or why not at all
    "frictioncontact": "tests/package/test_wheel.py", "fmi-sim": "tests/package/test_importers.py",
    "fmutool": "tests/package/test_importers.py", "cc": "tests/release/test_sources.py",
    "pip": "it changes the environment", "apt-get": "it changes the system", "xattr": "it is macOS's",
    "grep": "it is not ours",
}  # fmt: skip
C_CODE = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("fmu_src/**/*.[ch]"))


@cache
def run(*command: str | Path) -> str:
    done = subprocess.run(list(map(str, command)), cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@cache
def hunting(program: str) -> Path:
    return build_targets("default", [program]) / "hunt" / program


def read_options(module: str, options: list[str]) -> None:
    """By the module's own parser, which ends the process if it refuses one."""
    try:
        importlib.import_module(module).arguments(options)
    except SystemExit as ended:
        pytest.fail(f"{module} refuses {options}: {ended.code}")


def find_options(text: str, options: list[str]) -> None:
    for option in options:
        assert not option.startswith("-") or re.search(rf"(?<![\w-]){option}\b", text), f"{option} is unknown"


def start_script(path: Path, options: list[str]) -> None:
    """A shell script, which hands its options to a module, to a program in Python or to another script."""
    text = path.read_text(encoding="utf-8")
    if module := re.search(r"^run_module ([\w.]+)", text, re.MULTILINE):
        read_options(module[1], options)
    elif script := re.search(r'/scripts/(\w+)" --', text):
        start_script(ROOT / "scripts" / script[1], ["--output", "build", *options])
    elif program := re.search(r'/python" "\$PROJECT/(\S+)"', text):
        if options:
            find_options(run(sys.executable, ROOT / program[1], "--help"), options)
        elif "argparse" not in (ROOT / program[1]).read_text(encoding="utf-8"):
            run(sys.executable, ROOT / program[1])
    else:
        find_options(text, options)


def start(program: str, *options: str) -> None:
    name = program.rpartition("/")[2]
    if program.startswith(("scripts/", "bench/", "examples/", ".ci/")):
        start_script(ROOT / program, list(options))
    elif program.startswith("build/hunt/"):
        run(hunting(name), *(re.sub(r"^\d+$", "1", option) for option in options))  # a short one
    elif name == "python" and options[0] == "-m":
        assert importlib.util.find_spec(options[1])
    elif program == "python":  # beside the user's own files
        (file,) = ROOT.glob(f"examples/*/{options[0]}")
        find_options(run(sys.executable, file, "--help"), list(options))
    elif program.startswith(".venv/bin/"):
        seen = (
            os.devnull if option.endswith(".csv") else option for option in options if option != "--show-plot"
        )
        run(BIN / name, *seen)
    elif program == "fmpy":
        find_options(run(BIN / program, options[0], "--help"), list(options))
    elif program == "cmake":
        run(BIN / program, *options, *(["--", "-n"] if "--build" in options else ["-N"]))
    elif program == "ctest":
        run(BIN / program, *options, "-N")
    elif program in ("gdb", "break"):
        assert all(option in C_CODE for option in options if option.startswith("fc_"))
    else:
        assert program in ELSEWHERE, "no test starts it"


@pytest.mark.parametrize("line", dict.fromkeys(pages.lines()))
def test_line(line: str) -> None:
    for part in line.split("&&"):
        program = part.split()[0]
        is_ours = (ROOT / program.partition("/")[0]).is_dir()
        if is_ours or program == "break" or shutil.which(program, path=PATH):  # and no formula
            start(*shlex.split(part))
