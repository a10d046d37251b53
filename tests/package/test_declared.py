"""What pyproject.toml declares, requirements*.txt pin and texts name agree."""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import version

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tools import description
from tools.project import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def pins(*files: str) -> dict[str, str]:
    """Name -> pinned version, of the lines of the files."""
    lines = [line for file in files for line in (ROOT / file).read_text(encoding="utf-8").splitlines()]
    split = (line.split("==") for line in lines if "==" in line)
    return {canonicalize_name(name): version for name, version in split}


def wrong(declared: list[str], pinned: dict[str, str]) -> list[str]:
    """Those without a lower bound, not pinned, or pinned to a version that the declaration does not allow."""
    named = {text: Requirement(text) for text in declared}
    found = {text: pinned.get(canonicalize_name(one.name)) for text, one in named.items()}
    return [
        text for text, pin in found.items() if not pin or pin not in named[text].specifier or ">=" not in text
    ]


def test_what_users_install_imports_nothing_of_the_clone() -> None:
    paths = [*(ROOT / "frictioncontact").rglob("*.py")]
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    foreign = re.compile(r"^\s*(from|import) (examples|figures|tests|tools)\b", re.MULTILINE)
    assert len(texts) > 30 and [path for path, text in texts.items() if foreign.search(text)] == []


def test_what_is_declared_is_pinned_and_has_a_lower_bound() -> None:
    project = PROJECT["project"]
    extras = [one for group in project["optional-dependencies"].values() for one in group]
    files = ("requirements.txt", "requirements-dev.txt", "requirements-release.txt")
    assert wrong(project["dependencies"], pins(*files[:1])) == []  # for every command
    assert extras and wrong(extras, pins(*files[:2])) == []
    assert wrong(PROJECT["build-system"]["requires"], pins(*files)) == []


def test_the_version_is_that_of_the_model_description() -> None:
    wanted = description.read().version
    assert version("frictioncontact") == wanted, "scripts/setup installs the package anew"
    for file, line in (("CITATION.cff", r"version: (\S+)"), ("CHANGELOG.md", r"## (\S+)")):
        found = re.search(rf"^{line}", (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
        assert found is not None and found[1] == wanted
