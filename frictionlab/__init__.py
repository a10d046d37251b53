"""Shared parts of the commands in scripts/ and of the tests."""
