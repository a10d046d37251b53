"""The page about the related files: in the FMU, with a link to each of them, and to nothing else."""

from __future__ import annotations

import posixpath
import re
import zipfile
from pathlib import Path

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
PAGE = "documentation/fmi-ls-ref.html"


def links(text: str, name: str) -> set[str]:
    """Names in the FMU to which the page of this name links."""
    targets = re.findall(r'href="([^"#]+)"', text)
    return {posixpath.normpath(posixpath.join(posixpath.dirname(name), target)) for target in targets}


def test_it_links_every_related_file_and_nothing_else(fmu_path: Path) -> None:
    with zipfile.ZipFile(fmu_path) as archive:
        names = archive.namelist()
        text = archive.read(PAGE).decode()
    related = {name for name in names if name.startswith(f"{FOLDER}/")} - {f"{FOLDER}/fmi-ls-manifest.xml"}
    assert links(text, PAGE) == {*related, "documentation/index.html"}


def test_the_main_documentation_links_it(fmu_path: Path) -> None:
    with zipfile.ZipFile(fmu_path) as archive:
        index = archive.read("documentation/index.html").decode()
    assert PAGE in links(index, "documentation/index.html")
