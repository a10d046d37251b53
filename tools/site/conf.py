"""Configuration of Sphinx. The pages are the project's Markdown files, where they lie and as they are."""

import re
from collections.abc import Mapping
from pathlib import Path

from docutils.nodes import Element, SkipNode, document, inline, literal, math, math_block, row, table
from latex2mathml.converter import convert
from sphinx.addnodes import desc_annotation
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

from tools import description
from tools.project import ROOT

project = "FrictionContact"
author = "The FrictionContact authors"
copyright = "the FrictionContact authors, BSD-3-Clause"
version = release = description.read().version

extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "README"
include_patterns = [
    "*.md",
    "docs/*.md",
    "docs/tutorial/*.md",
    "examples/README.md",
    "examples/*/README.md",
    "data/measurements/README.md",
]
exclude_patterns = [".*", "build"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
html_math_renderer = "mathml"
smartquotes_action = "D"  # dashes only, which lists of parameters are written with
highlight_language = "none"  # of what names no language
default_role = "code"  # a name between single backticks, in Markdown as in docstrings
autodoc_typehints_format = "short"
autodoc_type_aliases = {"npt.ArrayLike": "ArrayLike"}  # by its name, not by its union of types
python_maximum_signature_line_length = 90
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True

html_theme = "sphinx_book_theme"
html_title = f"{project} {version}"
templates_path = ["templates"]
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_additional_pages = {"index": "front.html"}
html_search_scorer = str(Path(__file__).with_name("scorer.js"))
html_use_index = False  # the search finds names
html_domain_indices = False
html_context = {"default_mode": "auto"}  # light or dark, as the browser asks
html_theme_options = {
    "show_toc_level": 2,
    "home_page_in_toc": True,
    "use_download_button": False,
    "use_fullscreen_button": False,
    "secondary_sidebar_items": {"**": ["page-toc"], "docs/playground": []},
}
# A browser reads no file for a page that was opened from a folder: the excerpts under the hits of a search.
SUMMARY = "if (location.protocol === 'file:') DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;"

USERS = {
    "Tutorial": {
        "1. First force": "docs/tutorial/first-force",
        "2. Your surface": "docs/tutorial/your-surface",
        "3. Your machine": "docs/tutorial/your-machine",
        "4. Your sweep": "docs/tutorial/your-sweep",
        "5. What to trust": "docs/tutorial/what-to-trust",
    },
    "Using": {
        "First simulation and variables": "docs/using",
        "Couple it to your machine": "docs/machine",
        "The live page": "docs/playground",
    },
    "Tools": {
        "FMI tools": "docs/tools",
        "Python": "docs/python",
        "Python reference": "docs/api",
        "Model exchange": "docs/model-exchange",
        "Importers": "docs/compatibility",
        "Wrong calls and values": "docs/bad-input",
    },
    "Examples": {
        "Overview": "examples/README",
        "A mass inside": "examples/mass-inside/README",
        "A mass on a belt": "examples/stick-slip/README",
        "A mass in model exchange": "examples/model-exchange/README",
        "A friction law": "examples/friction-law/README",
        "A calibration by gradient": "examples/calibration/README",
        "A slow plant": "examples/ultrasonic-slider/README",
        "An ultrasonic motor": "examples/ultrasonic-motor/README",
        "Validation in CI": "examples/ci-validation/README",
        "A million scenarios": "examples/simulate-many/README",
        "Sweep": "examples/sweep/README",
    },
    "Physics": {
        "Equations": "docs/physics",
        "Three directions": "docs/three-directions",
        "Errata": "docs/errata",
    },
    "Measurements": {
        "Validation": "docs/validation",
        "Measured parameters": "docs/measured-parameters",
        "Data": "data/measurements/README",
    },
    "Trust": {"Accuracy, speed, stability": "docs/numerics", "Reliability": "docs/reliability"},
}
MAINTAINERS = {  # scorer.js has the same pages: a search finds them last
    "Maintainers": {
        "The solver": "docs/solver",
        "Contributing": "CONTRIBUTING",
        "Release": "docs/release",
        "Security": "SECURITY",
        "Changelog": "CHANGELOG",
    },
}
CONTENTS = {f"Users · {caption}": pages for caption, pages in USERS.items()} | MAINTAINERS
# On a phone, longest in characters
CELL = 50  # with a longer cell each row of the table is a paragraph
NUMBER = 9  # a cell that is not longer, such as 1e-6 or 21 (62 %), does not break
WORD = 24  # a longer word of code may break
PLAYGROUND = """
<p><a href="../playground.html">Open it in a window of its own</a></p>
<iframe class="playground" src="../playground.html" title="The FMU, alive" loading="lazy"></iframe>
"""


def toctree(pages: Mapping[str, str], caption: str) -> str:
    """A table of contents, title to page, that shows in the side bar only."""
    entries = [f"{title} <{page}>" for title, page in pages.items()]
    return "\n".join(["", "```{toctree}", ":hidden:", f":caption: {caption}", *entries, "```", ""])


def with_index(page: str) -> str:
    """Each table of variables after entries of the index, so that the search finds a name in its table."""
    parts = re.split(r"^(?=###? )", page, flags=re.MULTILINE)
    for k, part in enumerate(parts):
        cells = re.findall(r"^\| (`[^|]+`) \|", part, re.MULTILINE)
        names = re.findall(r"`([\w.()]+)`", " ".join(cells))
        if names and "| meaning |" in part:
            title, _, rest = part.partition("\n")
            entries = "".join(f"   ! single: {name}\n" for name in names)
            parts[k] = f"{title}\n\n```{{eval-rst}}\n.. index::\n{entries}```\n{rest}"
    return "".join(parts)


def complete(app: Sphinx, page: str, source: list[str]) -> None:
    """What the site adds to the pages, which other hosts of Markdown show as they are."""
    if page == root_doc:
        source[0] += "".join(toctree(pages, caption) for caption, pages in CONTENTS.items())
    elif page == "CHANGELOG":
        for version in app.config.older.split():
            link = f'<p><a href="{version}/index.html">The pages of {version}</a></p>'
            source[0] = source[0].replace(f"## {version}\n", f"## {version}\n\n{link}\n")
    elif page == "docs/using":
        source[0] = with_index(source[0])
    elif page == "docs/playground":
        title, _, rest = source[0].partition("\n")
        source[0] = f"{title}\n{PLAYGROUND}{rest}"


def plain_text(app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Docstrings are plain text: what reStructuredText would take for its own is escaped.

    Parameters in two columns, NAME  MEANING, become fields; what stands indented after an empty line is code.
    """
    written, code = [], False
    for before, line in zip(["", *lines], lines, strict=False):
        if line.strip():
            begins = line.startswith("    ") and not before.strip()
            written += ["::", ""] if begins and not code else []
            code = line.startswith("    ") and (code or begins)
        if not code:
            line = re.sub(r"^(returns|raises|warns) {2,}(?=\S)", r":\1: ", line)
            line = re.sub(r"^(\w+) {2,}(?=\S)", r":param \1: ", line)
            line = re.sub(r"(`[^`]*`)|([*|]|_(?!\w))", lambda found: found[1] or "\\" + found[2], line)
        written.append(line)
    lines[:] = written


def fit_phone(app: Sphinx, tree: document, page: str) -> None:
    """Marks long words of code, short cells and tables of long ones, whose cells get their headings."""
    for code in tree.findall(literal):
        if any(len(word) > WORD for word in code.astext().split()):
            code["classes"].append("long")
    for found in tree.findall(table):
        heading, *rows = found.findall(row)
        cells = [cell for each in rows for cell in each]
        for cell in cells:
            if len(cell.astext()) <= NUMBER:
                cell["classes"].append("short")
        if all(len(cell.astext()) <= CELL for cell in cells):
            continue
        found["classes"].append("stacked")
        for each in rows if len(heading) > 2 else []:
            for title, cell in zip(heading[1:], each[1:], strict=True):
                if cell.astext():
                    cell[0].insert(0, inline("", f"{title.astext()} ", classes=["label"]))


def without_paths(app: Sphinx, domain: str, kind: str, content: Element) -> None:
    """The value of a constant that is a path is that of the machine which builds the site: left out."""
    for annotation in list(content.parent.findall(desc_annotation)):
        if str(ROOT) in annotation.astext():
            annotation.parent.remove(annotation)


def visit_math(writer: HTML5Translator, node: math | math_block) -> None:
    """TeX as MathML, which browsers typeset. What a quad separates may stand on a line of its own."""
    is_block = isinstance(node, math_block)
    parts = re.split(r"\\q?quad", node.astext()) if is_block else [node.astext()]
    formulas = (convert(part, display="block" if is_block else "inline") for part in parts)
    tight = '<mo lspace="0" rspace="0">&#x0007C;</mo>'  # a bar of |V| is no relation
    formula = "".join(formulas).replace("<mo>&#x0007C;</mo>", tight)
    writer.body.append(f'<div class="formula">{formula}</div>' if is_block else formula)
    raise SkipNode


def to_front_page(app: Sphinx, page: str, template: str, context: dict, tree: Element | None) -> None:
    """The name of the project at the top of every page leads to the front page."""
    context["theme_logo_link"] = context["pathto"]("index")


def setup(app: Sphinx) -> None:
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math, None))
    app.connect("html-page-context", to_front_page)
    app.add_config_value("older", "", "env")
    app.connect("doctree-resolved", fit_phone)
    app.connect("object-description-transform", without_paths)
    app.connect("autodoc-process-docstring", plain_text)
    app.connect("source-read", complete)
    app.add_js_file(None, body=SUMMARY)
