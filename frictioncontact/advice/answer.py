"""`advise`: start values that hold an accuracy, graded against the FMU at its tightest tolerance."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from frictioncontact.advice.coulomb_bound import coulomb_errors
from frictioncontact.advice.question import LEAST, Output, Question, question
from frictioncontact.advice.stuck_mass import INSIDE, MASTERS, Master, coupling
from frictioncontact.errors import UserError
from frictioncontact.fmu import SETTLED, FrictionFmu, Value, opened, run, simulate
from frictioncontact.periodic import periodic_mean, periodic_waves
from frictioncontact.plausibility import WITH_STATIC_FRICTION
from frictioncontact.values import pairs, real

if TYPE_CHECKING:
    from frictioncontact.tables import Source

MOST = 1e-2  # solver.tolerance
TIGHT = 1e-10  # the tolerance that grades
# From five phases, since an error may vanish at one; steps of which not all are a whole number of periods.
PHASES = tuple(k / 5.0 for k in range(5))
STEPS = (1.0, 0.37, 1.0)  # over the communication step


@dataclass(frozen=True, repr=False)
class Advice:
    """The advised settings and their grade. str() prints them."""

    asked: Question
    settings: dict[str, Value]  # start values besides the scene's own
    why: str
    mean: float  # N, mean friction
    scale: float  # N, F_C: what errors are over
    largest: float  # N, S: what solver.tolerance is over
    error: float  # N, largest that was found

    @property
    def start_values(self) -> dict[str, Value]:
        """The scene's and the advised ones: start values for `simulate`."""
        return {**self.asked.given, **self.settings}

    @property
    def knows_the_mean(self) -> bool:
        """Whether some tolerance gives the accuracy for the mean friction."""
        return self.asked.accuracy * abs(self.mean) >= LEAST * self.largest

    def __repr__(self) -> str:
        settings = ", ".join(f"{name} = {value}" for name, value in self.settings.items())
        within = "" if math.isnan(self.error) else f"; within {self.asked.accuracy:g}"
        return f"<advice: {settings or 'none'}{within}>"

    def __str__(self) -> str:
        if math.isnan(self.error):  # of a mass
            return self.why
        asked, known = self.asked, self.knows_the_mean
        of_mean = f", {self.error / abs(self.mean):.1e} of the mean friction" if known else ""
        promise = (
            "of F_C and of the mean friction" if known else "of F_C; the mean friction is too small for it"
        )
        held = f"inputs {'linear' if asked.linear else 'held'}"
        steps = held if asked.inputs else f"and {STEPS[1] * asked.step:.4g} s, from rest and settled"
        lines = [
            self.why,
            f"Mean friction: {self.mean:.6g} N. Promise: within {asked.accuracy:g} {promise}.",
            f"Graded over steps of {asked.step:.6g} s, {steps}: {self.error / self.scale:.1e} F_C{of_mean}.",
        ]
        if asked.vibrates and asked.step > 0.5 * asked.period:
            lines.append("The step exceeds half a vibration period: connect F_t_mean, not F_t.")
        return "\n".join(lines)


def advise(
    scene: Mapping[str, Value] | None = None,
    *,
    accuracy: float = 1e-3,
    step: float | None = None,
    output: Output = "both",
    inputs: Source | None = None,
    linear: bool = False,
    phases: tuple[float, ...] = PHASES,
    mass: float | None = None,
    master: Master = MASTERS[0],
    fmu: str | Path | None = None,
) -> Advice:
    """Settings with which F_t and F_t_mean are accurate enough, relative to F_C and to the mean friction.

    scene     start values that describe it, SI units
    accuracy  largest error, over F_C and over the mean friction, from 1e-8 to 1
    step      communication step, s (a period of the vibration)
    output    which output must be accurate: "F_t", "F_t_mean" or "both"
    inputs    a table as of `simulate`, in even steps: the steps are its own, the first 400 are graded; a
              position gives its mean velocity over each step
    linear    inputs are linear between their samples; else held
    phases    of the vibration, over a period, from which it is graded
    mass      kg, that moves with the contact: advises on the coupling instead, while the contact sticks
    master    how the master exchanges values with it: "Jacobi", "Jacobi, reread", "Jacobi, linear",
              "Gauss-Seidel"; "inside" if the FMU moves it, as always where the scene has body.m
    fmu       another .fmu file of this model
    returns   an `Advice`: settings, start_values, mean and error [N] (nan of a mass); str() prints them
    raises    UserError: the question is wrong, or the FMU refuses the scene
    warns     FrictionWarning: of a setting that has no effect; of an unlikely magnitude

    The advice is graded against the FMU at solver.tolerance = 1e-10, from rest and settled.

        import frictioncontact as fc
        advice = fc.advise({"V": 0.5, "vibration.V_1": 1.44}, accuracy=1e-3, step=1e-3, output="F_t_mean")
        print(advice)
        fc.simulate(advice.start_values, stop=0.01, step=1e-3, outputs=["F_t_mean"])
    """
    loaded = opened(fmu)
    inside = pairs(scene, "scene").get("body.m", 0.0)
    if inside != 0.0:
        if mass not in (None, inside):
            raise UserError(f"mass = {mass}: the scene has body.m = {inside}; leave mass out")
        mass, master = real(inside, "body.m"), INSIDE
    if mass is not None and (step is None or inputs is not None or linear):
        raise UserError(
            "mass needs step and takes no inputs: it looks at the contact stuck at its start values"
        )
    asked = question(loaded, scene, accuracy, step, output, inputs, linear)
    if mass is not None:
        why, settings = coupling(loaded, asked.given, mass, asked.step, master)
        return Advice(asked, settings, why, math.nan, math.nan, math.nan, math.nan)
    mean, scale = mean_friction(loaded, asked), mean_limit(loaded, asked)
    if scale == 0.0:
        raise UserError("friction.mu F_n = 0 N: must be above 0 N, since the accuracy is relative to it")
    advice = Advice(asked, {}, "", mean, scale, largest_force(loaded, asked, scale), 0.0)
    goal = accuracy * (min(1.0, abs(mean) / scale) if advice.knows_the_mean else 1.0)
    settings, why = settings_for(loaded, asked, goal, goal * scale / advice.largest)
    errors = largest_errors(loaded, asked, settings, phases)
    error = {"both": max(errors), "F_t": errors[0], "F_t_mean": errors[1]}[output]
    if error > goal * scale:
        raise UserError(
            f"{why} It misses by {error / scale:.1e} F_C here, which is a fault: please report it"
        )
    return replace(advice, settings=settings, why=why, error=error)


def mean_friction(fmu: FrictionFmu, asked: Question) -> float:
    """Mean of F_t [N]: over the inputs, or once settled."""
    if asked.inputs:
        count = len(next(iter(asked.inputs.values()))) - 1
        rows = simulate(fmu, asked.given, asked.step, count, asked.inputs, asked.linear, asked.start)
        return float(rows["F_t_mean"][1:].mean())
    return periodic_mean(fmu, asked.given)


def mean_limit(fmu: FrictionFmu, asked: Question) -> float:
    """F_C, or the mean of mu F_n over a period [N]: the friction of Coulomb's law at a constant velocity."""
    forward: dict[str, Value] = {
        "friction.model": "Coulomb",
        "V": 1.0,
        "V_y": 0.0,
        "vibration.V_1": 0.0,
        "vibration.V_2": 0.0,
        "friction.sigma_2": 0.0,
    }
    with fmu.session({**asked.given, **forward}) as session:
        session.step(asked.period)
        return session.get("F_t_mean")


def largest_force(fmu: FrictionFmu, asked: Question, limit: float) -> float:
    """S [N] of docs/physics.md, over the inputs, or over a period once settled."""
    values, names = asked.values, ("sigma", "delta", "delta_y", "F_n")
    if asked.inputs:
        count = len(next(iter(asked.inputs.values()))) - 1
        rows = simulate(fmu, asked.given, asked.step, count, asked.inputs, asked.linear, asked.start, names)
        if values["friction.limit"] == "Load":
            limit = max(limit, float(values["friction.mu"]) * rows["F_n"].max())
    else:
        rows = periodic_waves(fmu, asked.given, names, periods=1, samples=64)
    speed = math.hypot(
        *(
            np.abs(asked.inputs.get(name, values[name])).max() + abs(values[amplitude])
            for name, amplitude in (("V", "vibration.V_1"), ("V_y", "vibration.V_2"))
        )
    )
    ratio = values["friction.staticRatio"] if values["friction.model"] in WITH_STATIC_FRICTION else 1.0
    damping = values["friction.sigma_1"] + values["friction.sigma_2"]
    stored = (rows["sigma"] * np.hypot(rows["delta"], rows["delta_y"])).max()
    return float(max(ratio * limit, stored, damping * speed))


def settings_for(
    fmu: FrictionFmu, asked: Question, goal: float, of_largest: float
) -> tuple[dict[str, Value], str]:
    """Start values that hold an error of goal over F_C, which is of_largest over S, and why they do."""
    if not asked.inputs:
        with fmu.session(asked.given) as session:
            sigma = session.get("sigma")
        of_F, of_mean = coulomb_errors(asked.values, sigma, asked.step)
        bound = {"both": max(of_F, of_mean), "F_t": of_F, "F_t_mean": of_mean}[asked.output]
        if bound <= goal:
            return {"friction.model": "Coulomb"}, f"Coulomb friction, which is within {bound:.1e} F_C here."
    of_largest *= 1.01  # an exponent is not lost to a force that exceeds F_C by a hair
    if of_largest < LEAST:
        least = asked.accuracy * LEAST / of_largest
        raise UserError(
            f"accuracy {asked.accuracy:g}: must be at least {least:.3g} here, "
            f"since solver.tolerance promises {LEAST:g} of the largest force, not of F_C"
        )
    tolerance = min(10.0 ** math.floor(math.log10(of_largest)), MOST)
    return {
        "solver.tolerance": float(f"{tolerance:.0e}")
    }, f"The default at solver.tolerance {tolerance:.0e}."


def largest_errors(
    fmu: FrictionFmu, asked: Question, settings: Mapping[str, Value], phases: tuple[float, ...]
) -> tuple[float, float]:
    """Largest differences [N] of F_t and F_t_mean to the FMU at its tightest tolerance.

    With inputs over their samples, from delta_0 = 0; without over some steps from every phase of the
    vibration, from delta_0 = 0 and settled.
    """
    if asked.inputs:
        runs: list[tuple[float, dict[str, Value]]] = [(asked.start, {})]
    else:
        starts = [phase * asked.period for phase in phases] if asked.vibrates else [0.0]
        runs = [(start, state) for start in starts for state in ({}, {**SETTLED})]
    errors = np.zeros(2)
    for start, state in runs:
        errors = np.maximum(errors, _run_errors(fmu, asked, {**settings, **state}, start))
    return float(errors[0]), float(errors[1])


def _run_errors(fmu: FrictionFmu, asked: Question, settings: Mapping[str, Value], start: float) -> np.ndarray:
    """Of one run from start [s]: from where the settings say."""
    if asked.inputs:
        steps = np.full(len(next(iter(asked.inputs.values()))) - 1, asked.step)
    else:
        steps = asked.step * np.array(STEPS)
    held = {name: samples[: len(steps)] for name, samples in asked.inputs.items()}
    rates = {name: np.diff(samples) / steps for name, samples in asked.inputs.items()} if asked.linear else {}
    tight = {"solver.tolerance": TIGHT, **{name: settings[name] for name in SETTLED if name in settings}}
    advised, right = (
        run(fmu, {**asked.given, **chosen}, steps, held, rates, start, ("F_t", "F_t_mean"))[1:]
        for chosen in (settings, tight)
    )
    return np.abs(advised - right).max(axis=0)
