"""Synthetic rigs: what hunt/reference.c gives, as an instrument with one fault writes it; what identify says.

`.venv/bin/python tests/rigs/rigs.py` prints the table of 200 rigs by fault, `--sentences` what a user reads.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

import frictioncontact as fc
from workshop.reference import after, scene, settled, step

LAWS = ("Dahl", "Coulomb", "ElasticPlastic", "LuGre")
FAULTS = ("none", "offset", "drift", "delay", "gain", "flipped sign", "wrong law", "peak to peak")
EACH = 25  # rigs of a fault
CHANCE = 0.01  # of the scatter alone to miss by as much as what a rig can show
NARROW = 2.0  # an interval from a value to less than so many times of it
STRIBECK = {"friction.staticRatio": 1.3, "friction.V_S": 0.02}  # V_S [m/s]; also in rig_scene


@dataclass(frozen=True)
class Rig:
    """What was measured, and what its user knows and asks for."""

    fault: str
    kind: str  # rows sorted by V, rows sorted by V_1, record
    data: pd.DataFrame
    start: dict[str, Any]
    truth: dict[str, float]  # of what is fitted
    scatter: float  # N
    uncertain: dict[str, float] | None  # as stated


def rig(fault: str, seed: int) -> Rig:
    random = np.random.default_rng([FAULTS.index(fault), seed])
    law = str(random.choice(LAWS))
    assumed = str(random.choice([other for other in LAWS if other != law])) if fault == "wrong law" else law
    F_C, scatter = random.uniform(10.0, 60.0), random.uniform(0.005, 0.05)
    record = fault == "delay" or (fault != "peak to peak" and random.random() < 0.35)
    kind = "record" if record else str(random.choice(["rows by V", "rows by V_1"]))
    sigma = F_C / random.uniform(0.5e-6, 5e-6)  # N/m
    frame = loop(random, law, F_C, sigma) if record else measured_rows(random, law, F_C, sigma, kind)
    force = "F_t [N]" if record else "F_t_mean [N]"
    exact = frame[force].to_numpy()
    frame[force] = with_fault(random, fault, frame, exact, F_C)
    frame[force] += scatter * F_C * random.standard_normal(len(frame))
    if fault == "peak to peak":
        frame["vibration.V_1 [mm/s]"] *= 2.0
    start = {"friction.model": assumed, "contact.model": "Constant"} | (
        STRIBECK if assumed == "LuGre" else {}
    )
    truth = {"F_C": F_C} | ({} if assumed == "Coulomb" else {"contact.sigma": sigma})
    stated = {force.split()[0]: scatter * F_C} if not record and random.random() < 0.5 else None
    return Rig(fault, kind, frame, start, truth, scatter * F_C, stated)


def rig_scene(law: str, F_C: float, sigma: float, **values: float) -> Any:
    ratio = {"staticRatio": 1.3, "V_S": 0.02} if law == "LuGre" else {}
    return scene(law=law, contact="Constant", F_C=F_C, contact_sigma=sigma, **ratio, **values)


def measured_rows(random: np.random.Generator, law: str, F_C: float, sigma: float, kind: str) -> pd.DataFrame:
    """A grid of velocities and amplitudes, sorted as they were measured."""
    f, kappa = random.uniform(20e3, 40e3), math.exp(random.uniform(math.log(0.3), math.log(3.0)))
    amplitude = kappa * 2.0 * math.pi * f * F_C / sigma  # m/s
    levels = ([0.0, 1.0], [0.5, 1.0], [0.0, 0.5, 1.0])[random.integers(3)]
    count = int(random.integers(4, 1 + 40 // len(levels)))
    V = amplitude * np.geomspace(random.uniform(0.02, 0.1), random.uniform(0.8, 1.5), count)
    order = [(v, a * amplitude) for v in V for a in levels]
    order.sort(key=lambda row: row if kind == "rows by V" else row[::-1])
    means = [settled(rig_scene(law, F_C, sigma, f=f, V=v, V_1=a))[0] for v, a in order]
    columns = ["V [mm/s]", "vibration.V_1 [mm/s]"]
    frame = pd.DataFrame(1e3 * np.array(order), columns=columns)
    return frame.assign(**{"vibration.f [kHz]": 1e-3 * f, "F_t_mean [N]": means})


def loop(
    random: np.random.Generator, law: str, F_C: float, sigma: float, samples: int = 0, finer: int = 4
) -> pd.DataFrame:
    """A loop that grows from within presliding to beyond; the motion is that of the finer samples."""
    samples, cycles = samples or int(random.integers(150, 400)), random.uniform(2.0, 3.5)
    duration = cycles * random.uniform(0.5, 2.0)
    t = np.linspace(0.0, duration, finer * (samples - 1) + 1)
    reach = random.uniform(3.0, 8.0) * F_C / sigma  # m
    w = 2.0 * math.pi * cycles / duration
    V = np.gradient(reach * np.sin(w * t) * (0.15 + 0.85 * t / duration), t, edge_order=2)
    h = t[1]
    now = rig_scene(law, F_C, sigma, V=V[0], V_rate=(V[1] - V[0]) / h, h=h)
    before, force = None, []
    for k in range(len(t) - 1):
        found = step(now, before)
        force += [found.F_t_start, found.F_t] if k == 0 else [found.F_t]
        if k + 2 < len(t):
            before, now = after(now, found, V=V[k + 1], V_rate=(V[k + 2] - V[k + 1]) / h)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (V[1:] + V[:-1]) * h)])
    frame = pd.DataFrame({"time [ms]": 1e3 * t, "position [um]": 1e6 * x, "F_t [N]": force})
    return frame[::finer].reset_index(drop=True)


def with_fault(
    random: np.random.Generator, fault: str, frame: pd.DataFrame, exact: np.ndarray, F_C: float
) -> np.ndarray:
    sign, part = random.choice([-1.0, 1.0]), np.linspace(0.0, 1.0, len(exact))
    if fault == "offset":
        return exact + sign * random.uniform(0.05, 0.3) * F_C
    if fault == "drift":
        return exact + sign * random.uniform(0.1, 0.4) * F_C * part
    if fault == "delay":
        time = frame["time [ms]"].to_numpy()
        late = random.uniform(0.002, 0.02) * time[-1]
        return np.interp(time - late, time, exact, left=0.0)
    if fault == "gain":
        return exact * random.choice([random.uniform(0.6, 0.9), random.uniform(1.1, 1.5)])
    return -exact if fault == "flipped sign" else exact


@dataclass(frozen=True)
class Verdict:
    rig: Rig
    said: str
    misfits: int
    judged: bool
    named: bool
    hidden: list[str]
    shows: bool  # with the true scatter in hand the best fit misses by too much
    held: dict[str, bool]
    narrow_and_wrong: bool


NAMES = {
    "offset": "offset", "drift": "drift", "delay": "delay", "flipped sign": "opposite sign",
    "wrong law": "friction.model = ", "peak to peak": "half the stated", "gain": "gain",
}  # fmt: skip


def verdict(case: tuple[str, int]) -> Verdict:
    made = rig(*case)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = fc.identify(made.data, list(made.truth), start=made.start, uncertain=made.uncertain)
    squares = float(np.sum((found.fit.residuals / made.scatter) ** 2))
    free = len(found.fit.residuals) - len(made.truth) - (made.kind == "record")
    held = {n: low <= made.truth[n] <= high for n, (low, high) in found.intervals.items()}
    narrow = [not held[n] and 0.0 < low and high < NARROW * low for n, (low, high) in found.intervals.items()]
    named = any(NAMES.get(made.fault, "?") in text for text in found.remedies)
    said = "\n".join([repr(found), *found.misfits, *found.remedies])
    return Verdict(
        made, said, len(found.misfits), found.judged, named, found.fit.hidden,
        stats.chi2.sf(squares, free) < CHANCE, held, any(narrow),
    )  # fmt: skip


def verdicts(each: int = EACH) -> Iterator[Verdict]:
    cases = [(fault, seed) for fault in FAULTS for seed in range(each)]
    with ProcessPoolExecutor() as pool:
        yield from pool.map(verdict, cases, chunksize=5)


def table(found: list[Verdict]) -> pd.DataFrame:
    """Counts by fault and by kind of data."""
    rows = [
        {
            "fault": one.rig.fault, "kind": one.rig.kind, "rigs": 1, "shown by the data": one.shows,
            "doubted": one.misfits > 0, "of these shown": one.misfits > 0 and one.shows, "named": one.named,
            "not judged": not one.judged and not one.misfits,
            "intervals": len(one.held), "hold the truth": sum(one.held.values()),
            "narrow, wrong, no misfit": one.narrow_and_wrong and not one.misfits,
        }
        for one in found
    ]  # fmt: skip
    counts = pd.DataFrame(rows)
    return pd.concat([counts.groupby(by).sum(numeric_only=True) for by in ("fault", "kind")])


def main() -> None:
    """The table; what a user reads of each rig with --sentences."""
    found = list(verdicts())
    for one in found if "--sentences" in sys.argv else ():
        about = f"{one.rig.fault}, {one.rig.kind}, {one.rig.start['friction.model']}"
        print(f"[{about}; the data show it: {one.shows}; held: {one.held}] {one.said}\n")
    print(table(found).to_string())


if __name__ == "__main__":
    main()
