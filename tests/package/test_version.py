"""What names a version names that of modelDescription.xml."""

from __future__ import annotations

import re
from importlib.metadata import version

import pytest

from workshop import description
from workshop.project import ROOT

VERSION = description.read().version


def test_the_installed_package() -> None:
    assert version("frictioncontact") == VERSION, "scripts/setup installs the package anew"


@pytest.mark.parametrize(
    ("file", "line"), [("CITATION.cff", r"version: (\S+)"), ("CHANGELOG.md", r"## (\S+)")]
)
def test_texts(file: str, line: str) -> None:
    found = re.search(rf"^{line}", (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None
    assert found[1] == VERSION
