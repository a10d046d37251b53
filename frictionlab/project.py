"""Where the project is, and the one error that every command turns into its one line."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


class UserError(Exception):
    """Something the user can mend; the text names it in one line."""
