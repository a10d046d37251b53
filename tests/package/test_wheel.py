"""The wheel where users are: an empty folder, a fresh environment, no compiler, no rights beside it."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pages
import pip
import pytest
from packaging.requirements import Requirement

from frictioncontact import resources
from tools.project import ROOT

pytest.importorskip("ziglang", reason="the release's packages are not installed: scripts/setup release")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="the rights are POSIX's"),
]
PAGE = "<title>a page</title>"  # tests/playground tests the real one
NOBODY = (
    {"user": 65534, "group": 65534, "extra_groups": ()} if os.name == "posix" and os.geteuid() == 0 else {}
)


@pytest.fixture(scope="module")
def wheel(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    from tools.release.wheel import packed

    folder = tmp_path_factory.mktemp("wheel")
    page = folder / "playground.html"
    page.write_text(PAGE, encoding="utf-8")
    return packed("wheel", folder / "made", [fmu_path, resources.batch_host(), page])


class User:
    """Who may write in one folder, and has on the path what is installed there."""

    def __init__(self, folder: Path) -> None:
        self.bin, self.work = folder / "environment" / "bin", folder / "work"
        self.plot = folder.parent / "plot"  # the packages of that extra
        for path in (folder, self.work):
            path.mkdir(exist_ok=True)
            if NOBODY:
                os.chown(path, 65534, 65534)
        self.run(python_of_all(), "-m", "venv", "--without-pip", str(folder / "environment"))

    def run(self, *command: str, given: str = "", **variables: str) -> str:
        environment = {"PATH": str(self.bin), "HOME": str(self.work), "LANG": "C.UTF-8", "COLUMNS": "120"}
        environment |= variables
        done = subprocess.run(
            [str(self.bin / command[0]) if "/" not in command[0] else command[0], *command[1:]],
            cwd=self.work, env=environment, input=given, capture_output=True, text=True, **NOBODY,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout


def python_of_all() -> str:
    """A Python of this version that who has no rights can start."""
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for path in (sys.executable, shutil.which(name, path="/usr/local/bin:/usr/bin:/bin")):
        with contextlib.suppress(OSError, TypeError):
            if subprocess.run([path, "-c", "import venv, ensurepip"], cwd="/", **NOBODY).returncode == 0:
                return str(path)
    pytest.skip(f"no {name} that other users can start")


@pytest.fixture(scope="module")
def user(wheel: Path) -> Iterator[User]:
    """With the wheel installed, and what it needs as the clone has it, already compiled."""
    with tempfile.TemporaryDirectory(prefix="frictioncontact-user-") as temporary:
        folder = Path(temporary)
        folder.chmod(0o755)  # pytest's own folders are closed to others
        user = User(folder / "home")
        # The clone's pip: to make one for the environment takes longer than to install all the rest.
        shutil.copytree(Path(pip.__file__).parent, folder / "pip" / "pip")
        (packages,) = user.bin.parent.glob("lib/*/site-packages")
        copy_with_all_it_needs("frictioncontact", packages)
        copy_with_all_it_needs("frictioncontact", user.plot, "plot", packages)
        shutil.copy(wheel, folder)
        install = ("install", "--quiet", "--no-index", "--no-deps", str(folder / wheel.name))
        for words in (install, ("check",)):
            user.run("python", "-m", "pip", *words, PYTHONPATH=str(folder / "pip"))
        yield user


def copy_with_all_it_needs(name: str, packages: Path, extra: str = "", beside: Path = Path()) -> None:
    """What a package requires, and so on, into a folder, unless it is beside; not the package itself."""
    packages.mkdir(exist_ok=True)
    for requirement in map(Requirement, distribution(name).requires or ()):
        with contextlib.suppress(PackageNotFoundError):  # needed elsewhere, as on Windows
            wanted = distribution(requirement.name)
            if requirement.marker is None or requirement.marker.evaluate({"extra": extra}):
                for part in {path.parts[0] for path in wanted.files or ()} - {"..", "__pycache__"}:
                    source, target = Path(wanted.locate_file(part)), packages / part
                    if source.is_dir() and not target.exists() and not (beside / part).exists():
                        shutil.copytree(source, target)
                    elif source.is_file():
                        shutil.copy2(source, target)
                copy_with_all_it_needs(requirement.name, packages, beside=beside)


def test_what_is_inside(wheel: Path) -> None:
    assert re.fullmatch(r"frictioncontact-[\d.]+-py3-none-(?!any)\w+\.whl", wheel.name)
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = archive.read(next(name for name in names if name.endswith("METADATA"))).decode()
    bundled = {name.removeprefix("frictioncontact/bundled/") for name in names if "/bundled/" in name}
    files = {"FrictionContact.fmu", resources.batch_host().name, "playground.html", "data/table2.csv"}
    assert files | {"data/measurements/friction-record.csv.gz"} <= bundled
    assert "frictioncontact/py.typed" in names
    assert not [name for name in names if name.startswith(("examples", "figures", "tests", "tools"))]
    for licence in ("LICENSE", "sundials-license.txt", "LICENSE-FrictionModels.txt"):
        assert any(name.endswith(licence) and "dist-info/licenses" in name for name in names), licence
    assert "License-Expression: BSD-3-Clause" in metadata


def test_a_user_has_no_compiler_and_the_first_block_is_short(user: User) -> None:
    assert not [tool for tool in ("cc", "gcc", "clang", "make") if shutil.which(tool, path=str(user.bin))]
    (code, printed), *_ = pages.BLOCK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert printed and len(code.splitlines()) <= 10


@pytest.mark.parametrize(("code", "shown"), pages.python(in_wheel=True))
def test_blocks_of_python(user: User, code: str, shown: str) -> None:
    """Without a warning; those that draw, with the extra for pictures."""
    path = {"PYTHONPATH": str(user.plot), "MPLBACKEND": "agg"} if "matplotlib" in code else {}
    printed = user.run("python", "-W", "error", "-c", code, **path)
    assert shown in ("", printed)


LINES = [line for line in pages.lines() if line.startswith("frictioncontact ")]
ALL = """import shlex, sys
from frictioncontact.__main__ import main
for line in sys.stdin:
    print(line, flush=True)
    sys.argv = shlex.split(line, comments=True)
    main()
"""


def test_every_line_of_the_pages_runs_and_what_needs_no_extra(user: User) -> None:
    """mine.csv is the user's own."""
    rows = "V [mm/s],vibration.V_1 [m/s],F_t_mean [N]", "100,1.44,5.5", "500,1.44,26.4", "1000,1.44,46.6"
    (user.work / "mine.csv").write_text("\n".join([*rows, "1400,1.44,54.6"]), encoding="utf-8")
    assert str(user.bin.parent) in user.run("frictioncontact", "version")
    (user.work / "all.py").write_text(ALL, encoding="utf-8")
    words = ("identify --quick", "advise --quick --set V=0.5", "playground --output page.html", "validate")
    printed = user.run(
        "python", "all.py", given="\n".join([*LINES, *(f"frictioncontact {w}" for w in words)])
    )
    assert all(line in printed for line in LINES) and len(LINES) > 5
    for said in ("stiffnessScale", "Promise", "misfit: 0.049 N"):
        assert said in printed
    assert (user.work / "page.html").read_text(encoding="utf-8") == PAGE


EXTRAS = """
from frictioncontact import *
import frictioncontact as fc
help(fc)
print(hasattr(fc, "sweep"))
law = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
fit = fc.identify(fc.contacts["steel-dry"].data, "contact.sigma", start=law)
law = fc.friction_law({"vibration.V_1": 1.0})
for call in (fit.plot, law.plot, lambda: sweep(output="out", vary={"V": "1,2"})):
    try:
        call()
    except fc.UserError as error:
        print(error)
"""


def test_what_needs_an_extra_is_there_and_says_so(user: User) -> None:
    """help() and import * reach every name; pictures and a sweep name their extra."""
    (user.work / "extras.py").write_text(EXTRAS)
    pictures = "pictures need matplotlib: pip install 'frictioncontact[plot]'\n"
    sweeps = "sweeps need pyarrow: pip install 'frictioncontact[sweep]'\n"
    assert user.run("python", "extras.py").endswith("True\n" + 2 * pictures + sweeps)
    assert user.run("frictioncontact", "sweep", "--help").startswith("usage: frictioncontact sweep")
