"""The web page of the report: tables and the figures that are drawn beside it; no network, no script."""

import html
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from workshop.figure import Figure, subscripts

ASSETS = Path(__file__).parent / "assets"


@dataclass(frozen=True)
class Table:
    """Cells are HTML; columns from the second on are set as numbers unless named in words."""

    heading: Sequence[str]
    rows: Sequence[Sequence[str]]
    words: Sequence[int] = (0,)


@dataclass(frozen=True)
class Section:
    key: str
    title: str
    intro: str  # HTML
    parts: Sequence[Table | Figure]


def text(label: str) -> str:
    """Subscripts as HTML."""
    return subscripts(label, "<sub>", "</sub>")


def page(title: str, lede: str, sections: Sequence[Section], footer: str) -> str:
    """The whole document."""
    template = (ASSETS / "page.html").read_text(encoding="utf-8")
    filled = {
        "TITLE": html.escape(title),
        "LEDE": lede,
        "LINKS": "".join(f'<a href="#{s.key}">{html.escape(s.title)}</a>' for s in sections),
        "BODY": "\n".join(map(_section, sections)),
        "FOOTER": footer,
        "STYLE": (ASSETS / "page.css").read_text(encoding="utf-8"),
    }
    for name, value in filled.items():
        template = template.replace("{{" + name + "}}", value)
    return template


def _section(section: Section) -> str:
    parts = [_figure(part) if isinstance(part, Figure) else _table(part) for part in section.parts]
    title = html.escape(section.title)
    return "\n".join([f'<section id="{section.key}"><h2>{title}</h2>', section.intro, *parts, "</section>"])


def _table(table: Table) -> str:
    def cells(row: Sequence[str], tag: str) -> str:
        return "".join(
            f"<{tag} class={'words' if k in table.words else 'number'}>{cell}</{tag}>"
            for k, cell in enumerate(row)
        )

    rows = "\n".join(f"<tr>{cells(row, 'td')}</tr>" for row in table.rows)
    return (
        f'<div class="scroll" tabindex="0"><table><thead><tr>{cells(table.heading, "th")}</tr></thead>'
        f"<tbody>{rows}</tbody></table></div>"
    )


def _figure(figure: Figure) -> str:
    title, caption = (text(html.escape(words, quote=False)) for words in (figure.title, figure.caption))
    picture = f'<img src="{figure.key}.svg" alt="{html.escape(figure.title)}" loading="lazy">'
    return f'<figure id="{figure.key}"><h3>{title}</h3>{picture}<figcaption>{caption}</figcaption></figure>'
