"""The scenes of the benchmarks, what is right in each by the reference, and the peers that solve them too."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from frictioncontact.fmu import Value
from frictioncontact.parameters import PERIOD, SEPARATION, STIFFNESS_PRINTED
from tools.bench.driver import Bench, Job, Outcome
from tools.reference import CHOICES, NAMES, Scene, changed, follow, rest, scene_of, step

SIGMAS = (6e4, 6e6, 6e8, 6e10, 6e12)  # N/m at 14 um
# No whole number of periods, so that what cancels over a period, and luck at one phase, do not count.
VIBRATING_STEP = 0.93 * PERIOD
STARTS = (0.0, 0.23 * PERIOD, 0.27 * PERIOD)


@dataclass(frozen=True)
class Case:
    """A scene with its communication steps; run from each of the starts [s]."""

    name: str
    title: str
    start_values: Mapping[str, Value]
    step: float = PERIOD  # s
    count: int = 4
    starts: tuple[float, ...] = (0.0,)
    inputs: Mapping[str, np.ndarray] = field(default_factory=dict)  # count + 1 samples
    linear: bool = False

    def job(
        self, start: float = 0.0, budget: float = 0.02, settings: Mapping[str, Value] | None = None
    ) -> Job:
        values = {**self.start_values, **(settings or {})}
        return Job(values, self.step, self.count, start, self.inputs, self.linear, budget)

    def scene_at(self, k: int, start: float) -> Scene:
        """The scene of step k, its inputs counted from the step's own start."""
        scene = changed(scene_of(self.start_values), start=start + k * self.step, h=self.step)
        samples = {NAMES[name]: values for name, values in self.inputs.items()}
        now = {name: float(v[k]) for name, v in samples.items()}
        rates = {}
        if self.linear:
            rates = {f"{name}_rate": float(v[k + 1] - v[k]) / self.step for name, v in samples.items()}
        return changed(scene, **now, **rates)

    @property
    def F_C(self) -> float:
        """What errors are over [N]: F_C, or mu times the mean of F_n over a period at the start."""
        scene = scene_of(self.start_values)
        forward = changed(scene, law="Coulomb", V=1.0, V_1=0.0, sigma_2=0.0, h=1.0 / scene.f)
        return float(step(forward).F_t_mean)


def expected(case: Case, start: float) -> tuple[np.ndarray, np.ndarray]:
    """F_t at the end of each step and its mean over the step [N]."""
    steps = follow(case.scene_at(k, start) for k in range(case.count))
    return np.array([each.F_t for each in steps]), np.array([each.F_t_mean for each in steps])


def vibrating(sigma: float) -> Case:
    values = {"vibration.V_1": 1.44, "vibration.a_d": 1.1e-6}
    return Case(
        f"vibrating-{sigma:.0e}".replace("+", ""),
        f"V and d vibrate, σ {sigma:.0e} N/m".replace("e+", "e"),
        {**values, "contact.stiffnessScale": sigma / STIFFNESS_PRINTED},
        step=VIBRATING_STEP,
        starts=STARTS,
    )


def sampled(samples_per_period: int, sigma: float, linear: bool, periods: int = 1) -> Case:
    """V and d of the vibration come from outside, as samples; the FMU's own vibration is off."""
    count = samples_per_period * periods
    angle = 2 * np.pi * (np.arange(count + 1) / samples_per_period + 0.13)
    kind = "linear" if linear else "held"
    return Case(
        f"sampled-{samples_per_period}-{kind}-{sigma:.0e}".replace("+", ""),
        f"{kind} samples, σ {sigma:.0e} N/m".replace("e+", "e"),
        {"contact.stiffnessScale": sigma / STIFFNESS_PRINTED},
        step=PERIOD / samples_per_period,
        count=count,
        inputs={"V": 0.005 + 1.44 * np.cos(angle), "d": SEPARATION + 1.1e-6 * np.cos(angle)},
        linear=linear,
    )


def cases() -> list[Case]:
    triangle = np.interp(np.arange(41), [0, 10, 30, 40], [0.0, 0.2, -0.2, 0.0])
    steps = np.random.default_rng(20).uniform(0.002, 0.02, 17)
    gaps = np.random.default_rng(21).uniform(13e-6, 15e-6, 17)
    constant = {"contact.model": "Constant", "contact.sigma": 2.5e6}
    V_alone, d_alone = constant | {"vibration.V_1": 1.44}, {"vibration.a_d": 1.1e-6}
    return [
        *(vibrating(sigma) for sigma in SIGMAS),
        Case("vibrating-V", "V vibrates, σ 2.5e6 N/m", V_alone, VIBRATING_STEP, starts=STARTS),
        Case("vibrating-d", "d vibrates, V 5 mm/s", d_alone, VIBRATING_STEP, starts=(0.0, 0.4 * PERIOD)),
        Case("held", "no vibration, V and d held", {}, step=1e-6, count=16, inputs={"V": steps, "d": gaps}),
        Case("linear", "presliding, V linear", constant, 5e-6, 40, inputs={"V": triangle}, linear=True),
        sampled(20, 6e6, linear=True),
        sampled(20, 6e12, linear=True),
        sampled(20, 6e6, linear=False),
    ]


# The peers: Radau IIA of orders 5, 9 and 13 that stops at reversals of V, and CVODE with its defaults, which
# passes over them. All solve y = (sigma_ref delta / F_C, integral of F_t dt / F_C) or its equal.
PLAIN_PROGRAMS = {
    "Radau 5": "plain_radau_5",
    "Radau 9": "plain_radau_9",
    "Radau 13": "plain_radau_13",
    "plain CVODE": "plain_cvode",
}


def plain_values(case: Case, tolerance: float) -> dict[str, float]:
    """The equation's few numbers, in the order of bench/plain_equation.h."""
    scene = scene_of(case.start_values)
    asperities = scene.contact != 1 + CHOICES["contact"].index("Constant")
    return {
        "V": scene.V,
        "d": scene.d,
        "F_C": scene.F_C,
        "sigma": rest(scene)[1],
        "d_ref": scene.d,
        "decay": getattr(scene, "lambda") / scene.R_q if asperities else 0.0,
        "f": scene.f,
        "V_1": scene.V_1,
        "a_d": scene.a_d,
        "phase_d": scene.phase_d,
        "tolerance": tolerance,
    }


def plain(bench: Bench, method: str, case: Case, tolerance: float, budget: float, start: float) -> Outcome:
    """One of PLAIN_PROGRAMS."""
    job, values = case.job(start, budget), plain_values(case, tolerance)
    lines = job.lines({"V": 0, "d": 1})
    lines += [f"real {k} {value!r}" for k, value in enumerate(values.values())]
    return bench.call([PLAIN_PROGRAMS[method]], [*lines, "output 0", "output 1"], job)
