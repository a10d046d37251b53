"""Sanitizers, fuzzers, soak and coverage: the long runs."""
