"""The web page with the FMU alive in it."""
