"""What makes and proves the FMU and its Python package; nothing of it is installed by users."""
