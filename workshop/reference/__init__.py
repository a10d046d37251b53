"""What a solver is graded against; shares no code with the FMU.

- `solution`: quadratures, at 40 digits or in extended precision; grades the FMU and made most of tests/data.
- `constant`: closed forms of a constant stiffness; grades periodic means and sensitivities.
- `collocation`, `stop_bisection`: other ways to the same results; grade `solution` alone (tests/reference).
- hunt/reference.c: brute force in extended precision; grades the hunt's scenes and, from Python
  (tests/reference/fast_reference.py), F_t_settled, model exchange and a part of tests/data.
"""
