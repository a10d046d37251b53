"""The code of a scenario for workers that know nothing of this project: a package as a file for Dask.

Its name holds a hash of its content, so that sweeps of different versions can meet on one cluster.
"""

from __future__ import annotations

import hashlib
import importlib
import sys
import zipfile
from pathlib import Path
from types import ModuleType

from distributed import Client

PACKAGE = Path(__file__).resolve().parents[1]
MODULES = ("__init__.py", "project.py", "batch/*.py", "sweep/__init__.py", "sweep/scenario.py")


def shipped(client: Client, folder: Path) -> ModuleType:
    """`sweep.scenario` as all workers of the client can import it. The file is written to the folder."""
    sources = {
        path.relative_to(PACKAGE).as_posix(): path.read_bytes()
        for pattern in MODULES
        for path in sorted(PACKAGE.glob(pattern))
    }
    name = "frictionlab_" + hashlib.sha256(repr(sources).encode()).hexdigest()[:16]
    file = folder / f"{name}.zip"
    with zipfile.ZipFile(file, "w") as archive:
        for path, source in sources.items():
            archive.writestr(f"{name}/{path}", source)
    client.upload_file(str(file))
    sys.path.append(str(file))
    importlib.invalidate_caches()
    return importlib.import_module(f"{name}.sweep.scenario")
