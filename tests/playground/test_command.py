"""scripts/playground: what it writes, and one line for what it can't."""

from __future__ import annotations

from pathlib import Path

import pytest

from frictioncontact.command import main
from frictioncontact.errors import UserError
from tools.playground import command


def test_it_writes_the_page(html: Path, tmp_path: Path) -> None:
    """The same bytes at every call."""
    output = tmp_path / "folder" / "page.html"
    main(command, ["-o", str(output)])
    assert output.read_bytes() == html.read_bytes()
    assert list(output.parent.iterdir()) == [output]


def test_what_goes_wrong_is_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(command, "page_text", lambda: "page")
    for output in ("/dev/null/page.html", str(tmp_path)):
        with pytest.raises(SystemExit, match=r"error: .*(folder|directory)") as stopped:
            main(command, ["-o", output])
        assert "\n" not in str(stopped.value) and list(tmp_path.iterdir()) == []

    def no_page() -> str:
        raise UserError("the cross compiler is missing: install it")

    monkeypatch.setattr(command, "page_text", no_page)
    with pytest.raises(SystemExit, match="error: the cross compiler is missing: install it"):
        main(command, ["-o", str(tmp_path / "page.html")])
