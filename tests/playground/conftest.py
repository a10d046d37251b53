"""The page, made once, in a browser that tells what a page must not do."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playground_page import Playground
from playwright.sync_api import Browser

from tools.playground.page import page_text
from tools.presets import Preset, presets

pytest.importorskip("ziglang", reason="the release's packages are not installed: scripts/setup release")


@pytest.fixture(scope="session")
def html(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("playground") / "playground.html"
    path.write_text(page_text(), encoding="utf-8")
    return path


@pytest.fixture
def playground(browser: Browser, html: Path) -> Iterator[Playground]:
    """Open on a desktop. Fails the test if the page had an error or asked for anything beyond itself."""
    context = browser.new_context(viewport={"width": 1440, "height": 900})
    playground = Playground(context.new_page(), html)
    playground.open()
    yield playground
    context.close()
    assert playground.problems == []


@pytest.fixture(scope="session")
def offered() -> list[Preset]:
    return presets()
