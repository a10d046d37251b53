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


def test_what_every_user_needs_is_pinned_for_every_command() -> None:
    assert wrong(PROJECT["project"]["dependencies"], pins("requirements.txt")) == []


def test_the_extras_are_pinned_for_development() -> None:
    extras = [one for group in PROJECT["project"]["optional-dependencies"].values() for one in group]
    assert extras and wrong(extras, pins("requirements.txt", "requirements-dev.txt")) == []


def test_what_builds_an_sdist_is_pinned() -> None:
    files = ("requirements.txt", "requirements-dev.txt", "requirements-release.txt")
    assert wrong(PROJECT["build-system"]["requires"], pins(*files)) == []


def test_every_declaration_has_a_lower_bound() -> None:
    extras = [one for group in PROJECT["project"]["optional-dependencies"].values() for one in group]
    declared = PROJECT["project"]["dependencies"] + extras + PROJECT["build-system"]["requires"]
    assert [text for text in declared if ">=" not in text] == []
