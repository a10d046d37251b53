"""The paper's equations, figures, tables and claims, from the FMU."""
