"""The wheel where users are: an empty folder, a fresh environment, no compiler, no rights beside it."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pip
import pytest

from frictioncontact import resources
from workshop.fmu_docs import tutorial
from workshop.project import ROOT

pytest.importorskip("lief", reason="the release's packages are not installed: scripts/setup release")
from workshop.release.wheel import packed

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
    folder = tmp_path_factory.mktemp("wheel")
    page = folder / "playground.html"
    page.write_text(PAGE, encoding="utf-8")
    return packed("wheel", folder / "made", [fmu_path, resources.batch_host(), page])


class User:
    """Who may write in one folder, and has on the path what is installed there."""

    def __init__(self, folder: Path) -> None:
        self.bin, self.work = folder / "environment" / "bin", folder / "work"
        for path in (folder, self.work):
            path.mkdir(exist_ok=True)
            if NOBODY:
                os.chown(path, 65534, 65534)
        self.run(python_of_all(), "-m", "venv", "--without-pip", str(folder / "environment"))

    def run(self, *command: str, **variables: str) -> str:
        environment = {"PATH": str(self.bin), "HOME": str(self.work), "LANG": "C.UTF-8", "COLUMNS": "120"}
        environment |= variables
        done = subprocess.run(
            [str(self.bin / command[0]) if "/" not in command[0] else command[0], *command[1:]],
            cwd=self.work, env=environment, capture_output=True, text=True, **NOBODY,
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
    """With the wheel and libcosim installed, their dependencies as the clone pins them."""
    with tempfile.TemporaryDirectory(prefix="frictioncontact-user-") as temporary:
        folder = Path(temporary)
        folder.chmod(0o755)  # pytest's own folders are closed to others
        # The clone's pip: to make one for the environment takes longer than to install all the rest.
        shutil.copytree(Path(pip.__file__).parent, folder / "pip" / "pip")
        download(folder, str(wheel), "libcosimpy", "matplotlib")
        user = User(folder / "home")
        install(user, wheel.name, "libcosimpy")
        yield user


@pytest.fixture(scope="module")
def newcomer(user: User) -> User:
    """With matplotlib too, as page 1 of the tutorial says; the tests further up need a user without it."""
    install(user, "matplotlib")
    return user


QUIET = ("--quiet", "--disable-pip-version-check")


def download(folder: Path, *packages: str) -> None:
    files = (ROOT / name for name in ("requirements.txt", "requirements-dev.txt", "constraints.txt"))
    lines = [line for file in files for line in file.read_text(encoding="utf-8").splitlines()]
    (folder / "pins.txt").write_text("\n".join(line for line in lines if "==" in line))
    command = [sys.executable, "-m", "pip", "download", *QUIET, "-c", str(folder / "pins.txt")]
    subprocess.run([*command, "-d", str(folder / "found"), *packages], check=True)


def install(user: User, *packages: str) -> None:
    folder = user.work.parent.parent
    names = [str(folder / "found" / name) if name.endswith(".whl") else name for name in packages]
    user.run(
        "python", "-m", "pip", "install", *QUIET, "--no-index", "--no-compile", "--find-links",
        str(folder / "found"), *names, PYTHONPATH=str(folder / "pip"),
    )  # fmt: skip


def test_what_is_inside(wheel: Path) -> None:
    assert re.fullmatch(r"frictioncontact-[\d.]+-py3-none-(?!any)\w+\.whl", wheel.name)
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = archive.read(next(name for name in names if name.endswith("METADATA"))).decode()
    bundled = {name.removeprefix("frictioncontact/bundled/") for name in names if "/bundled/" in name}
    files = {"FrictionContact.fmu", resources.batch_host().name, "playground.html", "data/table2.csv"}
    assert files | {"data/measurements/friction-record.csv.gz"} <= bundled
    assert "frictioncontact/py.typed" in names
    assert not [name for name in names if name.startswith(("workshop", "tests"))]
    for licence in ("LICENSE", "sundials-license.txt", "LICENSE-FrictionModels.txt"):
        assert any(name.endswith(licence) and "dist-info/licenses" in name for name in names), licence
    assert "License-Expression: BSD-3-Clause" in metadata


def test_the_lines_of_the_readme(user: User) -> None:
    assert not [tool for tool in ("cc", "gcc", "clang", "make") if shutil.which(tool, path=str(user.bin))]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (code, printed) = re.findall(r"```python\n(.*?)```\n+```text\n(.*?)```", text, re.DOTALL)[0]
    (user.work / "readme.py").write_text(code, encoding="utf-8")
    assert user.run("python", "readme.py") == printed
    assert len(code.splitlines()) <= 8


def test_commands_that_need_no_extra(user: User) -> None:
    """Besides those of the pages' lines."""
    version = user.run("frictioncontact", "version")
    assert str(user.bin.parent) in version
    assert "usage: frictioncontact gap" in user.run("frictioncontact", "gap", "--help")
    assert "stiffnessScale" in user.run("frictioncontact", "identify", "--quick")
    assert "Promise" in user.run("frictioncontact", "advise", "--quick", "--set", "V=0.5")
    user.run("frictioncontact", "playground", "--output", "page.html")
    assert (user.work / "page.html").read_text(encoding="utf-8") == PAGE
    assert "misfit: 0.049 N" in user.run("frictioncontact", "validate")
    assert "usage: frictioncontact sweep" in user.run("frictioncontact", "sweep", "--help")


PAGES = (
    "README.md",
    *(f"docs/{name}.md" for name in ("using", "machine", "python", "tools", "api", "measured-parameters")),
    "examples/friction-law/README.md",
)
LINES = [
    pytest.param(line.strip().replace("\\\n", ""), id=f"{page}: {line.strip()[:60]}")
    for page in PAGES
    for line in re.findall(
        r"^(?: {4})?(frictioncontact (?:.*\\\n)*.*)$", (ROOT / page).read_text("utf-8"), re.MULTILINE
    )
]


@pytest.mark.parametrize("line", LINES)
def test_every_line_of_the_pages_runs(user: User, line: str) -> None:
    """mine.csv and drive.csv are the user's own."""
    rows = "V [mm/s],vibration.V_1 [m/s],F_t_mean [N]", "100,1.44,5.5", "500,1.44,26.4", "1000,1.44,46.6"
    (user.work / "mine.csv").write_text("\n".join([*rows, "1400,1.44,54.6"]), encoding="utf-8")
    user.run(*shlex.split(line, comments=True))


@pytest.mark.parametrize("page", tutorial.PAGES, ids=lambda page: page.stem)
def test_a_page_of_the_tutorial_prints_and_draws_what_it_shows(newcomer: User, page: Path) -> None:
    code, printed = tutorial.blocks(page)
    (newcomer.work / "mine.csv").unlink(missing_ok=True)  # the lines of the pages have another of that name
    (newcomer.work / "page.py").write_text(code, encoding="utf-8")
    assert newcomer.run("python", "-W", "error::UserWarning:__main__", "page.py") == printed
    assert (newcomer.work / f"{page.stem}.png").is_file()
    assert len(page.read_text(encoding="utf-8").split()) <= 500


def test_what_needs_an_extra_is_there_and_says_so(user: User) -> None:
    """help() and import * reach every name; a sweep names its extra."""
    code = (
        "from frictioncontact import *; import frictioncontact as fc; help(fc); print(hasattr(fc, 'sweep'))\n"
        "try:\n    sweep(output='out', vary={'V': '1,2'})\nexcept ValueError as error:\n    print(error)\n"
    )
    (user.work / "all.py").write_text(code)
    needed = "sweeps need pyarrow: pip install 'frictioncontact[sweep]'"
    assert user.run("python", "all.py").endswith(f"True\n{needed}\n")
