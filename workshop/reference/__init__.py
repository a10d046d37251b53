"""What a solver is graded against; shares no code with the FMU."""
