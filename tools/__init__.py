"""What builds, releases, measures and checks the FMU and its Python package; users install nothing of it."""
