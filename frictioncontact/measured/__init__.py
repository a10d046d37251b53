"""Contacts that were measured, as data."""
