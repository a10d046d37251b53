"""Builds the FMU with CMake: `build_fmu()` for other commands, `python -m frictionlab.build` by itself.

CMAKE_ARGS in the environment is passed on when configuring, e.g. CMAKE_ARGS=-DWITH_SUNDIALS=OFF.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from rich.progress import Progress

from frictionlab.command import finish, progress_bar
from frictionlab.project import ROOT, UserError

PERCENT = re.compile(r"^\[\s*(\d+)%\] (.*)")


def presets() -> dict[str, Path]:
    """The build presets and the folders that they build in."""
    listed = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
    return {preset["name"]: Path(preset["binaryDir"].replace("${sourceDir}", str(ROOT))) for preset in listed}


def build_fmu(preset: str = "default", progress: Progress | None = None) -> Path:
    """Configures and builds a preset and gives the path of its FMU.

    Shows a bar in the given progress, or in one of its own.
    """
    if progress is None:
        with progress_bar() as own:
            return build_fmu(preset, own)
    folder = presets()[preset]
    task = progress.add_task("Configuring", total=100)
    cmake = [sys.executable, "-m", "cmake"]
    options = [f"-DPython3_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", ""))]
    _run([*cmake, "--preset", preset, *options], progress, task)
    _run([*cmake, "--build", str(folder), "--parallel", str(os.cpu_count() or 1)], progress, task)
    progress.remove_task(task)
    return folder / "FrictionContact.fmu"


def _run(command: list[str], progress: Progress, task: int) -> None:
    lines: list[str] = []
    with subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    ) as process:
        for line in process.stdout or ():
            lines.append(line)
            if match := PERCENT.match(line):
                progress.update(task, completed=int(match[1]), description=match[2].strip()[:50])
            elif line.startswith("-- Fetching"):
                progress.update(task, description="Fetching SUNDIALS")
    if process.returncode:
        raise UserError(_reason(lines))


def _reason(lines: list[str]) -> str:
    """CMake's own error message as one line, or else the compiler's output."""
    text = "".join(lines)
    if match := re.search(
        r"CMake Error at [^\n]*\(message\):\n(.*?)(?:Call Stack|-- Configuring|\Z)", text, re.DOTALL
    ):
        return " ".join(match[1].split())
    return "".join(line for line in lines if not PERCENT.match(line))[-6000:].strip()


def main() -> None:
    parser = argparse.ArgumentParser(prog="frictionlab.build", description="Build FrictionContact.fmu.")
    parser.add_argument("--preset", choices=list(presets()), default="default", help="build preset")
    finish(lambda options: print(f"built {build_fmu(options.preset).relative_to(ROOT)}"), parser.parse_args())


if __name__ == "__main__":
    main()
