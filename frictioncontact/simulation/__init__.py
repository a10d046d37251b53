"""One scene over time."""
