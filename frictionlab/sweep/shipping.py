"""The code of a scenario as a function that a machine without this project can run.

The function carries the sources of `fmu` and `sweep.scenario`. A worker writes them to a folder of its
own, under a package name with their hash, so that sweeps of different versions can meet on one cluster.
"""

from __future__ import annotations

import atexit
import hashlib
import importlib
import shutil
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import cloudpickle

from frictionlab.sweep.scenario import Sampling

MODULES = ("__init__", "fmu", "sweep/__init__", "sweep/scenario")


def shipped(sampling: Sampling) -> bytes:
    """Pickled function of (bytes of the FMU, numbered scenarios) that gives their rows."""
    here = Path(__file__).parents[1]
    sources = {f"{module}.py": (here / f"{module}.py").read_text() for module in MODULES}
    package = "frictionlab_" + hashlib.sha256(repr(sources).encode()).hexdigest()[:16]
    return pickled(partial(_call, sources, package, sampling.settle, sampling.samples))


def pickled(function: Callable) -> bytes:
    """A function together with its code, which must not need this module's other names."""
    module = sys.modules[__name__]
    cloudpickle.register_pickle_by_value(module)
    try:
        return cloudpickle.dumps(function)
    finally:
        cloudpickle.unregister_pickle_by_value(module)


def _call(
    sources: dict[str, str], package: str, settle: float, samples: int, fmu: bytes, numbered: list
) -> list[dict]:
    if package not in sys.modules:
        folder = tempfile.mkdtemp(prefix="friction-sweep-")
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        (Path(folder) / package / "sweep").mkdir(parents=True)
        for name, text in sources.items():
            (Path(folder) / package / name).write_text(text)
        sys.path.append(folder)
        importlib.invalidate_caches()
    scenario = importlib.import_module(f"{package}.sweep.scenario")
    return scenario.run_chunk(fmu, numbered, scenario.Sampling(settle, samples))
