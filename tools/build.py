"""Builds the FMU with CMake: `build_fmu()` for other commands, `python -m tools.build` by itself.

CMAKE_ARGS in the environment is passed on when configuring, e.g. CMAKE_ARGS=-DWITH_SUNDIALS=OFF.
"""

import argparse
import fcntl
import json
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from rich.progress import Progress

from frictioncontact.command import finish, progress_bar
from frictioncontact.errors import UserError
from tools.project import ROOT

PERCENT = re.compile(r"^\[\s*(\d+)%\] (.*)")
CMAKE_ERROR = re.compile(r"CMake Error(?: at [^\n]*)?:\s*\n?(.*?)(?:Call Stack|-- Configuring|\Z)", re.DOTALL)


def presets() -> dict[str, Path]:
    """The build presets and the folders that they build in."""
    listed = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
    folders = {preset["name"]: preset["binaryDir"] for preset in listed if not preset.get("hidden")}
    return {name: Path(folder.replace("${sourceDir}", str(ROOT))) for name, folder in folders.items()}


def build_fmu(preset: str = "default", progress: Progress | None = None) -> Path:
    """Configures and builds a preset and gives the path of its FMU.

    Shows a bar in the given progress, or in one of its own.
    """
    return build_targets(preset, (), progress) / "FrictionContact.fmu"


def build_targets(
    preset: str,
    targets: Sequence[str],
    progress: Progress | None = None,
    options: Sequence[str] = (),
    environment: Mapping[str, str] | None = None,
) -> Path:
    """Configures a preset and builds targets of CMake, without any the FMU; gives the folder of the build.

    Commands that are started together build one after the other. What a killed build left, and what came with
    a copied or renamed project, is built anew. environment: the whole of it, in place of this process's.
    """
    if progress is None:
        with progress_bar() as own:
            return build_targets(preset, targets, own, options, environment)
    folder = presets()[preset]
    task = progress.add_task("Waiting for another build", total=100)
    with _locked(folder):
        progress.update(task, description="Configuring")
        cmake = [sys.executable, "-m", "cmake"]
        unfinished = folder / "unfinished"
        anew = unfinished.exists() or _is_of_another_folder(folder)
        settings = [f"-DPython3_EXECUTABLE={sys.executable}", *options]
        settings += [*shlex.split(os.environ.get("CMAKE_ARGS", "")), *(["--fresh"] if anew else [])]
        chosen = ["--target", *targets] if targets else []
        chosen += ["--parallel", str(os.cpu_count() or 1), *(["--clean-first"] if anew else [])]
        for words in (["--preset", preset, *settings], ["--build", str(folder), *chosen]):
            _run([*cmake, *words], environment, unfinished, partial(progress.update, task))
    progress.remove_task(task)
    return folder


def forget(preset: str) -> None:
    """All of a preset is built anew the next time."""
    folder = presets()[preset]
    with _locked(folder):
        (folder / "unfinished").touch()


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Holds the lock of a build folder, which is made if it is new."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / "lock").open("w")
    except OSError as error:
        raise UserError(f"{error.filename} can't be written: {error.strerror}") from None
    with lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _is_of_another_folder(folder: Path) -> bool:
    """Whether CMake's cache in folder was made for sources that are elsewhere."""
    try:
        cache = (folder / "CMakeCache.txt").read_text(errors="replace")
    except FileNotFoundError:
        return False
    entries = re.findall(r"^CMAKE_(HOME_DIRECTORY|CACHEFILE_DIR):INTERNAL=(.*)$", cache, re.MULTILINE)
    here = {"HOME_DIRECTORY": ROOT, "CACHEFILE_DIR": folder}
    ours = [name for name, made in entries if Path(made).exists() and here[name].samefile(made)]
    return len(ours) < 2


def _run(
    command: list[str], environment: Mapping[str, str] | None, unfinished: Path, show: Callable[..., None]
) -> None:
    """Runs a command of CMake. The file `unfinished` stays if it is killed; if it fails, it tidies up."""
    lines: list[str] = []
    unfinished.touch()
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "errors": "replace"}
    with subprocess.Popen(command, cwd=ROOT, env=environment, **pipes) as process:
        for line in process.stdout or ():
            lines.append(line)
            if match := PERCENT.match(line):
                show(completed=int(match[1]), description=match[2].strip()[:50])
            elif line.startswith("-- Fetching"):
                show(description="Fetching SUNDIALS")
    if process.returncode >= 0:
        unfinished.unlink()
    if process.returncode:
        raise UserError(_reason(lines))


def _reason(lines: list[str]) -> str:
    """CMake's own error message as one line, or else the compiler's output."""
    if match := CMAKE_ERROR.search("".join(lines)):
        return " ".join(match[1].split())
    return "".join(line for line in lines if not PERCENT.match(line))[-6000:].strip()


def main() -> None:
    parser = argparse.ArgumentParser(prog="tools.build", description="Build FrictionContact.fmu.")
    parser.add_argument("--preset", choices=list(presets()), default="default", help="build preset")
    finish(lambda options: print(f"built {build_fmu(options.preset).relative_to(ROOT)}"), parser.parse_args())


if __name__ == "__main__":
    main()
