"""What pyproject.toml declares and what requirements*.txt pins agree."""

from __future__ import annotations

import tomllib

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from workshop.project import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def pins(*files: str) -> dict[str, str]:
    """Name -> pinned version, of the lines of the files."""
    lines = [line for file in files for line in (ROOT / file).read_text(encoding="utf-8").splitlines()]
    split = (line.split("==") for line in lines if "==" in line)
    return {canonicalize_name(name): version for name, version in split}


def wrong(declared: list[str], pinned: dict[str, str]) -> list[str]:
    """The declared ones that are not pinned, or pinned to a version that the declaration does not allow."""
    requirements = [Requirement(text) for text in declared]
    return [
        str(one)
        for one in requirements
        if (version := pinned.get(canonicalize_name(one.name))) is None or version not in one.specifier
    ]


def test_what_is_declared_is_pinned_and_has_a_lower_bound() -> None:
    needed, project = PROJECT["project"]["dependencies"], PROJECT["project"]
    extras = [one for group in project["optional-dependencies"].values() for one in group]
    builds = PROJECT["build-system"]["requires"]
    files = ("requirements.txt", "requirements-dev.txt", "requirements-release.txt")
    assert wrong(needed, pins(*files[:1])) == []  # for every command
    assert extras and wrong(extras, pins(*files[:2])) == []
    assert wrong(builds, pins(*files)) == []
    assert [text for text in needed + extras + builds if ">=" not in text] == []
