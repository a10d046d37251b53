"""Sanitizers, fuzzers, soak, coverage, mutants: the long runs."""
