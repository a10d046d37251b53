"""Parameters of the FMU from measurements."""
