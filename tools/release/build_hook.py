"""What goes into the package besides Python: hatchling calls it, as pyproject.toml says.

A wheel holds in frictioncontact/bundled/ the FMU, the batch host of its platform, the page of the live FMU
and the measurements. What is compiled comes from the folder that FRICTIONCONTACT_BUNDLE names, for the
platform tag FRICTIONCONTACT_PLATFORM; without these it is compiled here by CMake, for this platform. An
editable installation takes nothing: frictioncontact.resources finds it in the clone.
"""

import os
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PAGE = "playground.html"
DATA = ("contacts.toml", "table2.csv", "dry.csv", "measurements")


class BundleHook(BuildHookInterface):
    """Of both targets: the sdist takes along the page, which needs a cross compiler."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        root = Path(self.root)
        given = os.environ.get("FRICTIONCONTACT_BUNDLE")
        included = build_data["force_include"]
        if self.target_name == "sdist":
            if given and (Path(given) / PAGE).is_file():
                included[str(Path(given) / PAGE)] = PAGE
            return
        if version == "editable":
            return
        self.temporary = tempfile.TemporaryDirectory(prefix="frictioncontact-")
        folder = Path(given) if given else compiled(root, Path(self.temporary.name))
        tag = os.environ.get("FRICTIONCONTACT_PLATFORM") or sysconfig.get_platform()
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{tag.replace('-', '_').replace('.', '_')}"
        files = [*folder.glob("FrictionContact.fmu"), *folder.glob("friction_batch.*")]
        files += [path for path in (folder / PAGE, root / PAGE) if path.is_file()][:1]
        included.update({str(path): f"frictioncontact/bundled/{path.name}" for path in files})
        included.update({str(root / "data" / name): f"frictioncontact/bundled/data/{name}" for name in DATA})

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        if hasattr(self, "temporary"):
            self.temporary.cleanup()


def compiled(root: Path, folder: Path) -> Path:
    """The folder, with the FMU and the batch host of this platform built in it from the sources in root.

    solver.method = cvode is left out where the source of SUNDIALS is not there.
    """
    sundials = "ON" if (root / "build" / "sundials-source").is_dir() else "OFF"
    configure = ["-S", str(root), "-B", str(folder), "-DCMAKE_BUILD_TYPE=Release", "-DFC_WERROR=OFF"]
    configure += [f"-DPython3_EXECUTABLE={sys.executable}", f"-DWITH_SUNDIALS={sundials}", *_ninja()]
    build = ["--build", str(folder), "--config", "Release", "--target", "fmu", "friction_batch", "--parallel"]
    for arguments in (configure, build):
        subprocess.run([sys.executable, "-m", "cmake", *arguments], check=True, cwd=root)
    return folder


def _ninja() -> list[str]:
    """The generator of the package ninja, which needs no make."""
    try:
        import ninja
    except ImportError:
        return []
    return ["-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={Path(ninja.BIN_DIR) / 'ninja'}"]
