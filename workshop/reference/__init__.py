"""What a solver is graded against: the laws from their formulas; shares no code with the FMU.

- `solution`: one step, by quadratures in extended precision or at 40 digits.
- `settled`: the state and the mean force after infinitely many periods.

What tests alone need of it is in tests/physics: `course`, a contact from step to step, whose inputs may jump
between them.

hunt/reference.c is independent of these: brute force in extended precision, which grades the hunt's scenes.
"""
