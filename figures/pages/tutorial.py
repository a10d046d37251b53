"""The pages of the tutorial as programs: their blocks in order, and what these print."""

import re
from pathlib import Path

from tools.project import ROOT

PAGES = sorted((ROOT / "docs" / "tutorial").glob("*.md"))


def blocks(page: Path) -> tuple[str, str]:
    """The blocks of Python of a page as one program, and its blocks of text."""
    text = page.read_text(encoding="utf-8")
    code, printed = (
        "".join(re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE))
        for language in ("python", "text")
    )
    return code, printed
