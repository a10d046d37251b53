"""Single-token mutants of C code: one operator, number or function name replaced by another of its kind.

The code is taken as clang-format lays it out: binary operators stand between blanks, pointers and signs do
not. Comments, strings, directives and asserts are left alone.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

BINARY = {
    "+": ("-", "*"),
    "-": ("+",),
    "*": ("/", "+"),
    "/": ("*",),
    "<": ("<=", ">"),
    ">": (">=", "<"),
    "<=": ("<", ">="),
    ">=": (">", "<="),
    "==": ("!=",),
    "!=": ("==",),
    "&&": ("||",),
    "||": ("&&",),
    "+=": ("-=", "="),
    "-=": ("+=", "="),
    "*=": ("/=", "="),
}
WORDS = {
    "fmin": ("fmax",),
    "fmax": ("fmin",),
    "sin": ("cos",),
    "cos": ("sin",),
    "acos": ("asin",),
    "asin": ("acos",),
    "floor": ("ceil",),
    "ceil": ("floor",),
    "fabs": ("",),
    "true": ("false",),
    "false": ("true",),
    "by_d": ("by_E",),
    "by_E": ("by_d",),
    "continue": ("break",),
    "break": ("continue",),
}
TOKEN = re.compile(
    r"""
    (?P<skip> //[^\n]* | "(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)*' | ^[ ]*\#(?:[^\n\\]|\\\n|\\.)*
              | (?:_Static_assert|\bassert|FC_PRINTF_LIKE)\((?:[^()]|\([^()]*\))*\) | \bchar\ \w+\[[^\]]*\] )
    | (?P<number> \b(?:0x[0-9a-fA-F.]+(?:p[+-]?\d+)?|\d+\.?\d*(?:[eE][+-]?\d+)?)[uUlLfF]* )
    | (?P<word> \b[A-Za-z_]\w*\b )
    | [ ](?P<binary> \+=|-=|\*=|<=|>=|==|!=|&&|\|\||[-+*/<>] )[ ]
    | (?P<sign> (?<=[(,=?:] )-(?=[\w(]) | (?<=\()-(?=[\w(]) | (?<=return\ )-(?=[\w(]) )
    | (?P<negation> !(?=[\w(]) )
    """,
    re.VERBOSE | re.MULTILINE,
)


@dataclass(frozen=True)
class Site:
    """A token and what it is replaced by."""

    file: str  # under fmu_src
    begin: int
    end: int
    replacement: str


def _numbers(literal: str) -> tuple[str, ...]:
    digits = literal.rstrip("uUlLfF")
    if digits.isdigit():
        value = int(digits)
        return (str(value + 1),) if value == 0 else (str(value + 1), str(value - 1))
    if digits.startswith("0x"):
        return (f"({literal} + 1)",)
    return ("1.0",) if float(digits) == 0.0 else (f"({literal} * 1.01)", f"({literal} * 0.5)", "0.0")


def sites(file: str, text: str) -> list[Site]:
    """All single-token mutants of a file's text."""
    found = []
    for match in TOKEN.finditer(text):
        kind = match.lastgroup
        if kind is None or kind == "skip":
            continue
        token = match[kind]
        others: tuple[str, ...] = ("",)  # a sign or a negation goes
        if kind == "number":
            others = _numbers(token)
        elif kind == "word":
            others = WORDS.get(token, ())
        elif kind == "binary":
            others = BINARY[token]
        found += [Site(file, *match.span(kind), other) for other in others]
    return found


def mutated(text: str, site: Site) -> str:
    return text[: site.begin] + site.replacement + text[site.end :]


def line_at(text: str, position: int) -> tuple[int, str]:
    """Number, from 1, and stripped text of the line that holds a position."""
    number = text.count("\n", 0, position) + 1
    return number, text.split("\n")[number - 1].strip()
