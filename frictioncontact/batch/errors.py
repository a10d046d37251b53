"""What a batch refuses."""

from __future__ import annotations

from ..errors import UserError


class BatchError(UserError):
    """The batch can't be run, or a scenario was refused; the text is one line that says why."""
