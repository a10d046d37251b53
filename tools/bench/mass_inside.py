"""A mass inside the FMU against a mass in a master, in communication steps of 1 ms, for docs/machine.md.

    .venv/bin/python -m tools.bench.mass_inside      prints the table

    m v' = P(t) - F_t,      P = 80 N sin(2 pi 10 t), with a vibration 30 N

The error is the largest of v over the largest v, in 0.1 s from rest. What is right is hunt/reference.c.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from frictioncontact import style
from frictioncontact.advice.stuck_mass import GAUSS_SEIDEL, JACOBI
from frictioncontact.fmu import FrictionFmu, Session, Value, simulate
from tools.build import build_fmu
from tools.reference import follow, scene_of

H = 1e-3  # s
FINE = 2e-5  # s, between samples of P for the reference: linear between them, P is off by 2e-7 of itself
HELD, INSIDE = "inside, held", "inside, linear"
MASTERS = (JACOBI, GAUSS_SEIDEL, HELD, INSIDE)


@dataclass(frozen=True)
class Pulled:
    """A mass on a contact of a constant stiffness and limit."""

    law: str
    sigma: float  # N/m
    m: float  # kg
    vibrates: bool = False
    end: float = 0.1  # s

    @property
    def start_values(self) -> dict[str, Value]:
        contact: dict[str, Value] = {"contact.model": "Constant", "contact.sigma": self.sigma}
        moves: dict[str, Value] = {"V": 0.0, "vibration.V_1": 1.44 if self.vibrates else 0.0}
        return {"friction.model": self.law, "F_C": 55.0, **contact, **moves}

    @property
    def output(self) -> str:
        """The force that a master reads."""
        return "F_t_mean" if self.vibrates else "F_t"

    def pull(self, t: np.ndarray) -> np.ndarray:
        """P [N]."""
        return np.full_like(t, 30.0) if self.vibrates else 80.0 * np.sin(2.0 * np.pi * 10.0 * t)


ROWS = (
    Pulled("ElasticPlastic", 6e6, 1.0),
    Pulled("ElasticPlastic", 6e10, 1.0),
    Pulled("Dahl", 6e6, 1.0, vibrates=True),
    Pulled("Dahl", 6e4, 0.1, vibrates=True),
    Pulled("Dahl", 6e6, 0.01, vibrates=True),
)


@cache
def exact(row: Pulled, step: float = H) -> dict[str, np.ndarray]:
    """time [s], v [m/s] and F_t [N] at the ends of steps, by the reference."""
    part = step if row.vibrates else min(step, FINE)
    time = np.linspace(0.0, row.end, round(row.end / part) + 1)
    force = row.pull(time)
    start = scene_of({**row.start_values, "body.m": row.m})
    scenes = []
    for F, rate in zip(force, np.diff(force) / part, strict=False):
        each = type(start).from_buffer_copy(start)
        each.h, each.F, each.F_rate = part, F, rate
        scenes.append(each)
    found = follow(scenes)
    every = round(step / part)
    rows = np.array([(of.v, of.F_t) for of in found])[every - 1 :: every]
    return {"time": time[every::every], "v": rows[:, 0], "F_t": rows[:, 1]}


def by_master(
    session: Session, m: float, pull: np.ndarray, step: float, output: str, master: str
) -> np.ndarray:
    """Rows of v [m/s], F_t, F_t_mean [N], at the start and after each step of m [kg] under pull - output."""
    v, rows = 0.0, [(0.0, 0.0, 0.0)]
    force = 1 + ("F_t", "F_t_mean").index(output)
    for P in pull:
        if master == JACOBI:
            session.set("V", v)
        v += step * (P - rows[-1][force]) / m
        if master == GAUSS_SEIDEL:
            session.set("V", v)
        session.step(step)
        rows.append((v, *session.read(("F_t", "F_t_mean"))))
    return np.array(rows)


def coupled(fmu: FrictionFmu, row: Pulled, master: str, step: float = H) -> dict[str, np.ndarray]:
    """The same by a master, with F_t_mean [N]; forces are held from the start of a step on, unless linear."""
    count = round(row.end / step)
    time = step * np.arange(count + 1)
    pull = row.pull(time)
    outputs = ("body.v", "F_t", "F_t_mean")
    if master in (HELD, INSIDE):
        scene = {**row.start_values, "body.m": row.m}
        found = simulate(fmu, scene, step, count, {"body.F": pull}, master == INSIDE, outputs=outputs)
        return {"v": found.pop("body.v"), **found}
    with fmu.session(row.start_values) as session:
        rows = by_master(session, row.m, pull[:-1], step, row.output, master)
    return {"time": time, **dict(zip(("v", "F_t", "F_t_mean"), rows.T, strict=True))}


def error(fmu: FrictionFmu, row: Pulled, master: str) -> float:
    """The largest error of v over the largest v."""
    right = exact(row)["v"]
    return float(np.abs(coupled(fmu, row, master)["v"][1:] - right).max() / np.abs(right).max())


def table(fmu: FrictionFmu, rows: Sequence[Pulled] = ROWS) -> list[str]:
    """A line for each row, as docs/machine.md has it."""
    lines = []
    for row in rows:
        errors = " | ".join(f"{error(fmu, row, master):.2g}" for master in MASTERS)
        lines.append(
            f"| {row.law}, {row.sigma:.0e} N/m, {row.m:g} kg, {'on' * row.vibrates or 'off'} | {errors} |"
        )
    return lines


def draw(fmu: FrictionFmu, path: Path) -> None:
    """A pulled mass: v, F_t and F_t_mean at 1 ms with the mass inside, over the exact motion."""
    row = ROWS[0]
    truth, inside, jacobi = exact(row, 1e-4), coupled(fmu, row, INSIDE), coupled(fmu, row, JACOBI)
    figure, (speed, force) = style.subplots(2, 1, size=(5.2, 6.0), sharex=True)
    ms = 1e3 * inside["time"]
    speed.plot(1e3 * truth["time"], 1e3 * truth["v"], color=style.BLACK, lw=1.2, label="exact motion")
    speed.plot(ms, 1e3 * inside["v"], "o", color=style.BLUE, ms=3.5, label="mass inside, 1 ms")
    speed.plot(ms, 1e3 * jacobi["v"], "x", color=style.ORANGE, ms=4, label="mass in a Jacobi master, 1 ms")
    speed.set(ylabel="velocity v [mm/s]", title="80 N at 10 Hz pull a mass of 1 kg over a dry contact")
    force.plot(1e3 * truth["time"], row.pull(truth["time"]), color=style.GREY, lw=1.0, ls="--", label="pull")
    force.plot(1e3 * truth["time"], truth["F_t"], color=style.BLACK, lw=1.2, label="exact $F_t$")
    force.plot(ms, inside["F_t"], "o", color=style.BLUE, ms=3.5, label="$F_t$, mass inside")
    force.stairs(inside["F_t_mean"][1:], ms, color=style.GREEN, baseline=None, lw=1.2, label="$F_t$_mean")
    force.set(ylabel="force [N]", xlabel="time [ms]", xlim=(0.0, 1e3 * row.end), ylim=(-130.0, 90.0))
    speed.legend(loc="upper right")
    force.legend(loc="lower left", ncols=2)
    style.save(figure, path)


def main() -> None:
    print("|", " | ".join(MASTERS), "|")
    with FrictionFmu(build_fmu()) as fmu:
        print(*table(fmu), sep="\n")


if __name__ == "__main__":
    main()
