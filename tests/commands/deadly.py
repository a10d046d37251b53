"""What a worker does not survive, in a module that it imports fast."""

from __future__ import annotations

import os

import pyarrow as pa

from frictioncontact.sweeps.group import Job, Part


def deadly(job: Job, first: int, stop: int) -> Part:
    """Scenario 3 kills its process."""
    if first <= 3 < stop:
        os._exit(1)
    return Part(pa.py_buffer(b""), None, 0, 0.0)
