"""Intervals by profile likelihood: as far as a parameter can go while the others make up for it.

An end is where the least sum of squares with the parameter held, over all others, has risen by
t^2 s^2 (Raue and others, Bioinformatics 25, 2009, 1923-1929). Where it never rises that far within the
parameter's bounds the data give none on that side. An interval reaches as far as the farthest minimum below
that rise, and so may span values that are less likely. MINOS of iminuit gives the same ends where the least
sum of squares is a point, and none where it is a valley, of which a profile is to tell.
"""

import math

from scipy.optimize import brentq

from frictioncontact.identification.experiment import Experiment
from frictioncontact.identification.result import Fit, Minimum, nearest_turn
from frictioncontact.identification.search import Tell, silent, solve

LEAST, MOST = 1.5, 3.0  # factors by which the distance grows until an end is passed
CLOSE = 0.005  # relative, of the square root of the rise: close enough to the end
STEEP = 10.0  # a rise that is as good as none found: where the FMU refuses


class LowerMinimum(Exception):
    """A profile has come to a place with a smaller sum of squares than the fit's."""

    def __init__(self, found: Minimum) -> None:
        self.found = found


def profiles(experiment: Experiment, result: Fit, tell: Tell = silent) -> list[tuple[float, float]]:
    """Ends of the 95 % interval of each parameter, as values; -inf, 0 or inf where the data give none.

    What did not settle is added to the fit's warnings. LowerMinimum where the fit is not the least.
    """
    found = []
    for k, p in enumerate(experiment.parameters):
        ends = []
        for side, word in ((-1.0, "lower"), (1.0, "upper")):
            tell(f"{word} end of {p.name}")
            ends.append(_End(experiment, result, k, side, f"the {word} end of {p.name}'s interval").value())
        found.append((ends[0], ends[1]))
    return found


class _End:
    """The search for one end along the distance from the fit in the coordinate k."""

    def __init__(self, experiment: Experiment, result: Fit, k: int, side: float, name: str) -> None:
        self.experiment, self.result, self.k, self.side, self.name = experiment, result, k, side, name
        bound = experiment.high[k] if side > 0 else experiment.low[k]
        self.reach = math.pi if experiment.parameters[k].periodic else abs(bound - result.point[k])
        self.gain = min(1e-3, max(1e-9, CLOSE * result.rise / (result.squares + result.rise)))
        self.others = [  # minima that the interval holds
            nearest_turn(result.parameters, one.point, result.point)
            for one in result.minima[1:]
            if one.squares < result.squares + result.rise
        ][:3]
        self.last, self.last_point = 0.0, result.point  # the farthest below the end, so far
        for point in self.others:
            away = side * (point[k] - result.point[k])
            if away > self.last:
                self.last, self.last_point = away, point
        self.seen = {0.0: -1.0}

    def value(self) -> float:
        """The end; where there is none, the end of all that the parameter may be."""
        p, x = self.result.parameters[self.k], float(self.result.point[self.k])
        if not math.isfinite(self.result.variance):
            return math.nan
        distance = self.distance()
        if math.isfinite(distance):
            return p.to_value(x + self.side * distance)
        if p.periodic:
            return x + self.side * math.pi
        return 0.0 if p.logarithmic and self.side < 0 else self.side * math.inf

    def distance(self) -> float:
        """From the fit in the coordinate; inf where there is no end within reach."""
        near, width = self.last, self.result.half_widths[self.k]
        place = max(width if 0.0 < width < math.inf else 0.1 * self.reach, LEAST * near)
        while near < self.reach:
            place = min(place, self.reach)
            excess = self.excess(place)
            if excess >= 0.0:
                return brentq(self.excess, near, place, xtol=1e-9, rtol=1e-3)
            near, grown = place, 1.05 * place / max(1.0 + excess, 1e-3)
            place = max(LEAST * near, min(MOST * near, grown))
        return math.inf

    def excess(self, distance: float) -> float:
        """Square root of the rise at a distance, over that of an end, minus 1; 0 where it is close to 0."""
        if distance not in self.seen:
            self.seen[distance] = self._excess(distance)
        return self.seen[distance]

    def _excess(self, distance: float) -> float:
        result, origin = self.result, self.result.point
        ahead = 0.0 if self.last == 0.0 else min(distance / self.last, MOST)
        starts = [origin + ahead * (self.last_point - origin), *(one.copy() for one in self.others)]
        for start in starts:
            start[self.k] = origin[self.k] + self.side * distance
        found = [solve(self.experiment, one, result.target, self.k, self.gain) for one in starts]
        best = min(found, key=lambda one: one.squares)
        if not math.isfinite(best.squares):
            self._say(f"{self.name} is where the FMU refuses: {self.experiment.problem}")
            return STEEP
        if not best.settled:
            self._say(f"{self.name} is not settled: the search for the others did not end")
        if best.squares < result.squares - 0.05 * result.rise:
            raise LowerMinimum(best)
        excess = math.sqrt(max(0.0, best.squares - result.squares) / result.rise) - 1.0
        if excess <= 0.0 and distance > self.last:
            self.last, self.last_point = distance, best.point
        return 0.0 if abs(excess) < CLOSE else min(excess, STEEP)

    def _say(self, text: str) -> None:
        about = text.partition(":")[0]
        if not any(told.startswith(about) for told in self.result.warnings):
            self.result.warnings.append(text)
