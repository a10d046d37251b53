"""The blocks of the documents: Python, and lines that start programs."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from markdown_it import MarkdownIt

from figures.pages import tutorial
from tools.project import ROOT

DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md")])
# And what it prints.
BLOCK = re.compile(r"^```python\n(.*?)^```(?:\n+```text\n(.*?)^```)?", re.DOTALL | re.MULTILINE)
NOT_IN_A_WHEEL = re.compile(r"libcosimpy|OMSimulator|\bbuild/")


def python(in_wheel: bool) -> list[object]:
    """Blocks that a wheel can run, or the others: code and what it prints. A tutorial is one program."""
    blocks: list[object] = []
    for page in DOCUMENTS:
        is_one = page in tutorial.PAGES
        found = [tutorial.blocks(page)] if is_one else BLOCK.findall(page.read_text(encoding="utf-8"))
        for number, block in enumerate(found):
            if in_wheel != bool(NOT_IN_A_WHEEL.search(block[0])):
                blocks.append(pytest.param(*block, id=f"{page.relative_to(ROOT).with_suffix('')}-{number}"))
    return blocks


def lines() -> Iterator[str]:
    """Every line of the indented blocks, without comments, and code in a sentence that has options."""
    page_of_fmu = (ROOT / "docs" / "fmu" / "page.html").read_text(encoding="utf-8")
    yield from re.findall(r"<pre><code>(.*?)</code>", re.sub(r"\\\n *", "", page_of_fmu))
    for page in DOCUMENTS[1:]:  # CHANGELOG.md is history
        for token in MarkdownIt().enable("table").parse(page.read_text(encoding="utf-8")):
            if token.type == "code_block":
                for line in re.sub(r"\\\n *", "", token.content).splitlines():
                    yield re.split(r" {2,}|\s#", line.strip().removeprefix("- run: "))[0]
            for child in token.children or ():
                if child.type == "code_inline" and re.search(r"\s-", child.content):
                    yield child.content.replace(" ...", "")
