"""The build succeeds whatever came before it, and ends in one line where it can't."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from tools.packing.archive import write_fmu
from tools.project import ROOT

FMU = "build/debug/FrictionContact.fmu"
BINARY = "binaries/linux64/FrictionContact.so"
BUILD = [sys.executable, "-m", "tools", "tools.build", "--preset", "debug"]
PIPES = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "start_new_session": True}
LINUX_ONLY = pytest.mark.skipif(sys.platform != "linux", reason="shared libraries are loaded as on Linux")

# A compiler that leaves objects cut short, and is killed, with all that called it, when it has begun to write
# the library.
COMPILER = """#!/bin/bash
if [[ -e $KILL_WHILE_LINKING && " $* " =~ " -o "([^ ]+) ]]; then
    output=${BASH_REMATCH[1]}
    case " $* " in
        *" -c "*/fmu_src/*) head -c 100 "$BASH" >"$output"; exit ;;
        *" -shared "*FrictionContact*) : >"$output"; kill -KILL 0 ;;
    esac
fi
exec cc "$@" -O0 -g0
"""


@pytest.fixture
def project(copy_project: Callable[[Path], Path], tmp_path: Path) -> Path:
    """A clean checkout."""
    return copy_project(tmp_path / "checkout")


def start(project: Path, compiler: Path, text: str, **variables: str) -> subprocess.Popen[str]:
    """Builds with this compiler; without SUNDIALS, which would only take time."""
    compiler.write_text(text)
    compiler.chmod(0o755)
    environment = {**os.environ, "CMAKE_ARGS": "-DWITH_SUNDIALS=OFF", "CC": str(compiler), **variables}
    return subprocess.Popen(BUILD, cwd=project, env=environment, **PIPES)


@LINUX_ONLY
@pytest.mark.slow
def test_killed_while_linking_and_two_at_once(project: Path, tmp_path: Path) -> None:
    """With what a kill can leave of objects and of an archive, and make takes for current."""
    kill, compiler = tmp_path / "kill", tmp_path / "compiler"
    kill.touch()
    killed = start(project, compiler, COMPILER, KILL_WHILE_LINKING=str(kill))
    killed.communicate(timeout=600)
    folder = project / "build/debug"
    assert killed.returncode == -9 and not (folder / "FrictionContact.so").exists()
    (archive,) = folder.rglob("libfriction_core.a")
    archive.write_bytes(archive.read_bytes()[:100])
    kill.unlink()
    for process in [start(project, compiler, COMPILER, KILL_WHILE_LINKING=str(kill)) for _ in range(2)]:
        output, errors = process.communicate(timeout=600)
        assert (process.returncode, output) == (0, f"built {FMU}\n"), output + errors
    with zipfile.ZipFile(project / FMU) as built:
        ctypes.CDLL(built.extract(BINARY, tmp_path)).fmi2GetVersion.restype = ctypes.c_char_p


def interrupted(process: subprocess.Popen[str], reached: Path) -> str:
    """What the command says when Control-C on a terminal reaches its group, once the file is there."""
    end = time.monotonic() + 600.0
    while not reached.exists():
        assert process.poll() is None and time.monotonic() < end, "waited in vain"
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGINT)
    output, errors = process.communicate(timeout=600)
    assert (process.returncode, output) == (130, "")
    return errors


@LINUX_ONLY
def test_interrupted_while_building(project: Path, tmp_path: Path) -> None:
    reached = tmp_path / "reached"
    process = start(project, tmp_path / "compiler", f"#!/bin/bash\ntouch {reached}\nsleep 3600\n")
    assert interrupted(process, reached) == "stopped\n"


# What it reaches is a folder: a file has a destructor, in which Control-C would be lost.
SLOW = """import os, time
class Slow:
    def __del__(self):
        os.mkdir({!r})
        time.sleep(3600)
Slow()
time.sleep(3600)
"""


@LINUX_ONLY
@pytest.mark.parametrize("words", ["tools frictioncontact.gap --help", "frictioncontact simulate --help"])
def test_interrupted_while_importing(tmp_path: Path, words: str) -> None:
    """With a slow numpy. Python drops an exception in a destructor, and imports may catch or change one."""
    reached = tmp_path / "reached"
    (tmp_path / "numpy.py").write_text(SLOW.format(str(reached)))
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    process = subprocess.Popen([sys.executable, "-m", *words.split()], env=environment, **PIPES)
    assert interrupted(process, reached) == "stopped\n"


def test_what_is_no_library_is_not_packed(fmu_path: Path, tmp_path: Path) -> None:
    """Empty, cut anywhere, or something else."""
    with zipfile.ZipFile(fmu_path) as archive:
        content = archive.read(BINARY)
    library, xml = tmp_path / "FrictionContact.so", ROOT / "modelDescription.xml"
    parts = [content[:length] for length in (0, 3, 50, 64, len(content) // 2, len(content) - 1)]
    for part in (*parts, b"#!/bin/sh\n"):
        library.write_bytes(part)
        with pytest.raises(ValueError, match=f"^{library} is .*: remove it and build again$"):
            write_fmu(library.with_suffix(".fmu"), xml, {"linux64": library}, {}, {})
    assert list(tmp_path.iterdir()) == [library]
