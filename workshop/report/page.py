"""The web page of the report: one file that needs no network, light and dark, from phone to desktop."""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from plotly.offline import get_plotlyjs

from workshop.figure import Figure
from workshop.report.panels import panel_data, text

ASSETS = Path(__file__).parent / "assets"


@dataclass(frozen=True)
class Table:
    """Cells are HTML; columns from the second on are set as numbers unless named in words."""

    heading: Sequence[str]
    rows: Sequence[Sequence[str]]
    words: Sequence[int] = (0,)
    note: str = ""


@dataclass(frozen=True)
class Section:
    key: str
    title: str
    intro: str  # HTML
    parts: Sequence[Table | Figure]


def page(title: str, lede: str, sections: Sequence[Section], footer: str) -> str:
    """The whole document."""
    panels: dict[str, object] = {}
    body = "\n".join(_section(section, panels) for section in sections)
    links = "".join(f'<a href="#{s.key}">{html.escape(s.title)}</a>' for s in sections)
    data = json.dumps(panels, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace(
        "</", "<\\/"
    )
    template = (ASSETS / "page.html").read_text(encoding="utf-8")
    filled = {
        "TITLE": html.escape(title),
        "LEDE": lede,
        "LINKS": links,
        "BODY": body,
        "FOOTER": footer,
        "STYLE": (ASSETS / "page.css").read_text(encoding="utf-8"),
        "DATA": data,
        "SCRIPT": (ASSETS / "page.js").read_text(encoding="utf-8"),
        "PLOTLY": get_plotlyjs(),
    }
    for name, value in filled.items():  # plotly last: no name can stand in its text by chance
        template = template.replace("{{" + name + "}}", value)
    return template


def _section(section: Section, panels: dict[str, object]) -> str:
    parts = [_figure(part, panels) if isinstance(part, Figure) else _table(part) for part in section.parts]
    return (
        f'<section id="{section.key}"><h2>{html.escape(section.title)}</h2>\n{section.intro}\n'
        + "\n".join(parts)
        + "</section>"
    )


def _table(table: Table) -> str:
    def cells(row: Sequence[str], tag: str) -> str:
        return "".join(
            f"<{tag} class={'words' if k in table.words else 'number'}>{cell}</{tag}>"
            for k, cell in enumerate(row)
        )

    rows = "\n".join(f"<tr>{cells(row, 'td')}</tr>" for row in table.rows)
    note = f'<p class="note">{table.note}</p>' if table.note else ""
    return (
        f'<div class="scroll" tabindex="0"><table><thead><tr>{cells(table.heading, "th")}</tr></thead>'
        f"<tbody>{rows}</tbody></table></div>{note}"
    )


def _figure(figure: Figure, panels: dict[str, object]) -> str:
    boxes = []
    for k, panel in enumerate(figure.panels):
        key = f"{figure.key}-{k}"
        panels[key] = panel_data(panel)
        title = text(html.escape(panel.title, quote=False))
        boxes.append(
            f'<div class="panel"><h4>{title}</h4><div class="plot" data-panel="{key}" role="img" '
            f'aria-label="{html.escape(figure.title)}: {html.escape(panel.title)}"></div></div>'
        )
    columns = min(figure.columns, 3)
    return (
        f'<figure id="{figure.key}"><h3>{text(html.escape(figure.title, quote=False))}</h3>'
        f'<div class="panels columns-{columns}">{"".join(boxes)}</div>'
        f"<figcaption>{text(html.escape(figure.caption, quote=False))}</figcaption></figure>"
    )
