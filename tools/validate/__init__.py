"""Holds every law of friction against measurements that others published."""
