"""The page from its parts: one HTML file that loads nothing."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from frictionlab.presets import Preset, possible

ASSETS = Path(__file__).with_name("assets")
PLACE = re.compile(r"/\*\[([\w.]+)\]\*/|<!--\[(\w+)\]-->")


def page(wasm: bytes, description: dict[str, Any], presets: Sequence[Preset]) -> str:
    """The text of the page; presets with a variable or an item that the FMU has not are left out."""
    parts = {
        "version": description["version"],
        "description": _json(description),
        "presets": _json([_fields(preset) for preset in possible(presets, description["variables"])]),
        "controls": _json(json.loads((ASSETS / "controls.json").read_text(encoding="utf-8"))),
        "wasm": base64.b64encode(wasm).decode(),
    }

    def part(match: re.Match[str]) -> str:
        asset, name = match.groups()
        return (ASSETS / asset).read_text(encoding="utf-8").strip() if asset else parts[name]

    return PLACE.sub(part, (ASSETS / "page.html").read_text(encoding="utf-8"))


def _fields(preset: Preset) -> dict[str, Any]:
    return {name: value for name, value in asdict(preset).items() if value is not None}


def _json(value: object) -> str:
    """JSON that can stand in a script element."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
