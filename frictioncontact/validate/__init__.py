"""Holds the measured contacts against their measurements."""
