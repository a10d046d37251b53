"""What a worker does not survive, in a module that it imports fast."""

from __future__ import annotations

import os

import pyarrow as pa

from frictioncontact.sweeps.workers import Group, Job, Part


def deadly(job: Job, group: Group) -> Part:
    """Scenario 3 kills its process."""
    if group[0] <= 3 < group[1]:
        os._exit(1)
    return Part(pa.py_buffer(b""), pa.py_buffer(b""), 0)
