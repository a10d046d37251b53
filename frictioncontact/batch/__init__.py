"""Many scenarios of an FMU at its own speed: `simulate_many`, over the batch runner in C of host/batch.h."""

from ..errors import BatchError
from .many import simulate_many

__all__ = ["BatchError", "simulate_many"]
