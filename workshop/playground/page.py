"""The page from its parts: one HTML file that loads nothing."""

import base64
import json
import re
from dataclasses import asdict
from pathlib import Path
from typing import Any

from workshop.description import description
from workshop.playground.core import core
from workshop.presets import Preset, presets

ASSETS = Path(__file__).with_name("assets")
PLACE = re.compile(r"/\*\[([\w.]+)\]\*/|<!--\[(\w+)\]-->")


def page_text() -> str:
    """The page of this FMU; UserError says why it can't be compiled."""
    model = description()
    parts = {
        "version": model["version"],
        "description": _json(model),
        "presets": _json([_fields(preset) for preset in presets()]),
        "controls": _json(json.loads((ASSETS / "controls.json").read_text(encoding="utf-8"))),
        "wasm": base64.b64encode(core()).decode(),
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
