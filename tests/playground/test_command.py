"""scripts/playground: what it writes, and one line for what it can't."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from frictioncontact.errors import UserError
from workshop.playground import command


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> None:
    monkeypatch.setattr(sys, "argv", ["playground", *arguments])
    command.main()


def test_it_writes_the_page(
    html: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same bytes at every call."""
    output = tmp_path / "folder" / "page.html"
    run(monkeypatch, "-o", str(output))
    assert output.read_bytes() == html.read_bytes()
    assert str(output) in capsys.readouterr().out
    assert list(output.parent.iterdir()) == [output]


@pytest.mark.parametrize("output", ["/dev/null/page.html", "."])
def test_an_output_that_can_t_be_written_is_one_line(
    output: str, html: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(command, "page_text", lambda: html.read_text(encoding="utf-8"))
    with pytest.raises(SystemExit) as stopped:
        run(monkeypatch, "-o", output)
    message = str(stopped.value)
    assert message.startswith(f"error: {output} can't be written") and "\n" not in message
    assert list(tmp_path.iterdir()) == []


def test_a_missing_compiler_is_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def no_page() -> str:
        raise UserError("the cross compiler is missing: install it")

    monkeypatch.setattr(command, "page_text", no_page)
    with pytest.raises(SystemExit, match="error: the cross compiler is missing: install it"):
        run(monkeypatch, "-o", str(tmp_path / "page.html"))
    assert list(tmp_path.iterdir()) == []
