"""import frictioncontact: what it gives, and that nothing heavy is loaded before it is used."""

from __future__ import annotations

import subprocess
import sys

import pytest

import frictioncontact as fc
from tools import description

HEAVY = ("numpy", "pandas", "scipy", "fmpy", "matplotlib", "rich", "dask", "pyarrow")


def printed(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_nothing_heavy_is_imported_with_it() -> None:
    code = f"import sys, frictioncontact; print([name for name in {HEAVY} if name in sys.modules])"
    assert printed(code) == "[]\n"


def test_what_is_used_loads_no_more() -> None:
    code = (
        "import sys, frictioncontact as fc; str(fc.contacts); text = str(fc.contacts['steel-dry']);"
        "print('interval, SI   contact.sigma 7.56e+06 to 7.96e+06' in text, 'fmpy' in sys.modules);"
        "fc.simulate(stop=1e-4, step=5e-5); fc.simulate_many({'V': 0.5});"
        "print([name for name in ('matplotlib', 'dask', 'scipy', 'pint') if name in sys.modules])"
    )
    assert printed(code) == "True False\n[]\n"


WITHOUT_POSIX = """
import importlib, os, pkgutil, signal, sys
for name in ("fcntl", "grp", "pwd", "resource", "termios"):
    sys.modules[name] = None
for name in ("SIGALRM", "setitimer", "ITIMER_REAL"):
    delattr(signal, name)
del os.sched_getaffinity, os.geteuid
import frictioncontact, frictioncontact.__main__
names = [module.name for module in pkgutil.walk_packages(frictioncontact.__path__, "frictioncontact.")]
for name in names:
    importlib.import_module(name)
print(len(names) > 30)
sys.argv = ["frictioncontact", "gap", "--load", "100"]
frictioncontact.__main__.main()
"""


def test_it_runs_where_there_is_no_posix() -> None:
    """As on Windows: every module is imported, and a command runs."""
    done = subprocess.run([sys.executable, "-c", WITHOUT_POSIX], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("True\n") and "start values: d 1.62784943e-05" in done.stdout


def test_every_name_is_there_and_stays_what_it_is() -> None:
    """Also once the rooms that hold it are imported."""

    for name in fc.__all__:
        assert getattr(fc, name) is getattr(fc, name)
        assert name in dir(fc)
    assert all(map(callable, (fc.simulate, fc.simulate_many, fc.sweep, fc.identify, fc.advise)))
    assert fc.__version__ == description.read().version


def test_a_name_that_is_none_has_a_hint() -> None:
    for name, hint in (("Friction_Law", "; did you mean friction_law?"), ("fmu_path", "")):
        with pytest.raises(AttributeError) as caught:
            getattr(fc, name)
        assert str(caught.value) == f"module 'frictioncontact' has no attribute {name!r}{hint}"
        assert caught.value.obj is None  # or Python adds a second hint
