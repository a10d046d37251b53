"""How the FMU is made of its parts: the C table of its variables, and the archive. The build runs these."""
