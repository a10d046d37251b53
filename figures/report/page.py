"""The report as one HTML page: report.md with its tables, the figures and docs/errata.md."""

import html
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from markdown_it import MarkdownIt

from figures.figure import Figure, text
from frictioncontact.periodic import reduction
from frictioncontact.table2 import Result, conditions
from tools.project import ROOT

FOLDER = Path(__file__).parent
REGIMES = ("regimes", "mean", "reduction")
Claims = Sequence[tuple[str, float, float, float | None, str]]


def page(results: Sequence[Result], claims: Claims, figures: Mapping[str, Figure], footer: str) -> str:
    """The whole document."""
    shown = {key: figure_html(figure) for key, figure in figures.items()}
    parts = shown | {
        "claims": claims_table(claims),
        "table-2": table_2(results),
        "figures": "".join(shown[key] for key in shown if key.startswith("fig-")),
        "regimes": "".join(shown[key] for key in REGIMES),
        "errata": errata(),
    }
    source = (FOLDER / "report.md").read_text(encoding="utf-8")
    source = re.sub(r"\[\[([\w-]+)\]\]", lambda match: parts[match[1]], source)
    made = MarkdownIt().enable("table").render(source)
    made = re.split(r"(<code.*?</code>|<[^>]*>)", made, flags=re.DOTALL)
    body = "".join(part if k % 2 else text(part, "<sub>", "</sub>") for k, part in enumerate(made))
    title = re.search(r"^# (.*)$", source, re.MULTILINE)[1]
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark"><link rel="icon" href="data:,"><title>{title}</title>
<style>{(FOLDER / "page.css").read_text(encoding="utf-8")}</style></head>
<body>{body}<footer>{footer}</footer></body></html>
"""


def figure_html(figure: Figure) -> str:
    title, caption = (html.escape(words, quote=False) for words in (figure.title, figure.caption))
    picture = f'<img src="{figure.key}.svg" alt="{html.escape(figure.title)}" loading="lazy">'
    return f'<figure id="{figure.key}"><h3>{title}</h3>{picture}<figcaption>{caption}</figcaption></figure>\n'


def table(heading: str, rows: Iterable[Sequence[str]]) -> str:
    """In Markdown, after a line that aligns its columns."""
    return "\n".join([heading, *(f"| {' | '.join(row)} |" for row in rows)]) + "\n"


def claims_table(claims: Claims) -> str:
    heading = "| Change of the mean, in % | paper | exact | identified | why |\n|---|--:|--:|--:|---|"
    cells = (
        [words, percent(printed, 0), *("" if x is None else percent(x, 2) for x in values), why]
        for words, printed, *values, why in claims
    )
    return table(heading, cells)


def percent(value: float, digits: int) -> str:
    return "0" if abs(value) < 5e-7 else f"{value:+.{digits}f}".replace("-", "−")


def table_2(results: Sequence[Result]) -> str:
    def less(mean: float, without: float, digits: int) -> str:
        return f"{round(reduction(mean, without), digits) + 0.0:.{digits}f} %"

    first = results[0]
    names = "| Row | paper, N | less by | exact, N | less by | identified, N | less by |\n"
    rows = [
        [
            f"{each.row.number}: {conditions(each.row).replace('$', '')}",
            f"{each.row.paper_force:.0f}",
            f"{each.row.paper_reduction:.0f} %",
            f"{each.exact:.4f}",
            less(each.exact, first.exact, 2),
            f"{each.identified:.2f}",
            less(each.identified, first.identified, 1),
        ]
        for each in results
    ]
    return table(f"{names}|---{'|--:' * 6}|", rows)


def errata() -> str:
    """docs/errata.md one level deeper, without its title, links and figures."""
    words = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
    words = words[words.index("The FMU computes") :]
    words = re.sub(r"!\[[^\]]*\]\([^)]*\)\n", "", words)
    words = re.sub(r"\[([^\]]+)\]\([^)]*\)", r"docs/\1", words).replace("docs/tests/", "tests/")
    return re.sub(r"(?m)^##", "###", words)
