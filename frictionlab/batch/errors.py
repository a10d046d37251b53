"""What a batch refuses before it runs."""

from __future__ import annotations


class BatchError(ValueError):
    """The batch can't be run, or a scenario was refused; the text is one line that says why."""
