"""Fits named parameters of the FMU to measurements by least squares, with intervals and a judgement in words.

Intervals: linear ones, value -+ t s sqrt(C) in the coordinates, from the derivatives at the solution; and
by profile likelihood (profile.py), which hold where the sum of squares is no parabola.
"""

import dataclasses
import math

from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.faults import hidden, remedies, shapes
from frictioncontact.identification.judge import judge
from frictioncontact.identification.profile import LowerMinimum, profiles
from frictioncontact.identification.result import Fit
from frictioncontact.identification.search import Tell, described, search, silent

RESTARTS = 5  # from lower minima that profiles come to


def fit(experiment: Experiment, tell: Tell = silent) -> Fit:
    """Least squares from the best of some sampled starts, or from the given start values.

    Where the law does not fit, its remedies are sought.

    UserError where there are fewer rows than parameters; FrictionError where the FMU refuses every start.
    """
    result = with_profiles(experiment, search(experiment, experiment.target, tell), tell)
    of_faults = shapes(experiment, result)
    judge(experiment, result, of_faults)
    if result.misfits:
        tell("what explains the misfit")
        result.remedies.extend(remedies(experiment, result))
    elif result.degrees > 0:
        result.hidden.extend(hidden(experiment, result, of_faults))
    return result


def with_profiles(experiment: Experiment, result: Fit, tell: Tell = silent) -> Fit:
    """The fit with the intervals by profile, or the one of a lower minimum that they come to."""
    for _ in range(RESTARTS):
        try:
            return dataclasses.replace(result, profiles=profiles(experiment, result, tell))
        except LowerMinimum as lower:
            result = described(experiment, result.target, [lower.found, *result.minima])
    result.warnings.append("the fit and its intervals are not settled: each search finds a smaller misfit")
    return dataclasses.replace(result, profiles=[(math.nan, math.nan)] * len(result.parameters))
