"""Makes sweep.csv: 500 random scenes with what the reference gives for them.

    python tests/data/make_sweep.py

Takes half a minute. The seed is fixed: the file changes only with the reference or the distribution below.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

from frictioncontact.files import whole_file
from workshop.reference import solution as reference
from workshop.reference.arithmetic import multiprecision
from workshop.reference.solution import MP, Contact, Scene

SEED = 20240607
COUNT = 500
SCENE_COLUMNS = "V d E V_rate d_rate E_rate start f V_1 a_d phase_d F_C".split()
COLUMNS = [
    *SCENE_COLUMNS,
    *"contact_model contact_sigma stiffnessScale h delta_0 tolerance delta F_t F_t_mean work".split(),
]


def log_uniform(random: np.random.Generator, low: float, high: float) -> float:
    return float(low * (high / low) ** random.random())


def random_velocity(random: np.random.Generator, V_1: float) -> float:
    sign = float(random.choice([-1.0, 1.0]))
    kind = random.random()
    if kind < 0.05:
        return 0.0
    if V_1 > 0.0 and kind < 0.35:  # dips and tangential reversals
        return sign * V_1 * (1.0 + float(random.choice([-1.0, 1.0])) * log_uniform(random, 1e-8, 1e-1))
    return sign * log_uniform(random, 1e-4, 10.0)


def random_scene(random: np.random.Generator) -> tuple[Scene, float]:
    """A scene and the duration of its step [s]."""
    f = log_uniform(random, 1e3, 1e5)
    V_1 = log_uniform(random, 1e-3, 3.0) if random.random() < 0.75 else 0.0
    d = float(random.uniform(12e-6, 17e-6))
    a_d = log_uniform(random, 1e-8, 2.5e-6) if random.random() < 0.7 else 0.0
    V = random_velocity(random, V_1)
    E = float(random.uniform(40e9, 70e9))
    sigma = log_uniform(random, 6e4, 6e12)
    if random.random() < 0.2:
        contact = Contact(model="Constant", sigma=sigma)
    else:
        contact = Contact(stiffnessScale=sigma / float(reference.stiffness(Contact(), d, E)))
    linear = random.random() < 0.35
    periods = log_uniform(random, 1e-2, 1e1 if linear and (V_1 or a_d) else 1e3)
    h = periods / f
    rates = {}
    if linear:
        speed = max(abs(V), V_1, 1e-3)
        rates = {
            "V_rate": float(random.uniform(-2.0, 2.0)) * speed / h,
            "d_rate": float(random.uniform(-1.0, 1.0)) * 1e-6 / h,
            "E_rate": float(random.uniform(-0.3, 0.3)) * E / h,
        }
        for name in rates:
            if random.random() < 0.3:
                rates[name] = 0.0
    scene = Scene(
        V=V,
        d=d,
        E=E,
        start=log_uniform(random, 1e-6, 1e3) if random.random() < 0.7 else 0.0,
        f=f,
        V_1=V_1,
        a_d=a_d,
        phase_d=float(random.uniform(-2 * np.pi, 2 * np.pi)),
        F_C=log_uniform(random, 1.0, 1e3),
        contact=contact,
        **rates,
    )
    return scene, h


def text(value: object) -> str:
    return str(MP.nstr(multiprecision(value), 20))


def row_of(scene: Scene, h: float, delta_0: float, tolerance: float) -> dict[str, object]:
    t1 = MP.mpf(scene.start) + MP.mpf(h)
    delta, impulse, work = reference.solve(scene, scene.start, t1, delta_0)
    return {
        **{name: repr(getattr(scene, name)) for name in SCENE_COLUMNS},
        "contact_model": scene.contact.model,
        "contact_sigma": repr(scene.contact.sigma),
        "stiffnessScale": repr(scene.contact.stiffnessScale),
        "h": repr(h),
        "delta_0": repr(delta_0),
        "tolerance": repr(tolerance),
        "delta": text(delta),
        "F_t": text(reference.force(scene, t1, delta)),
        "F_t_mean": text(multiprecision(impulse) / MP.mpf(h)),
        "work": text(work),
    }


def main() -> None:
    random = np.random.default_rng(SEED)
    path = Path(__file__).with_name("sweep.csv")
    with whole_file(path) as unfinished, unfinished.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for k in range(COUNT):
            scene, h = random_scene(random)
            at_start = scene.F_C / float(reference.sigma(scene, scene.start))
            delta_0 = float(random.uniform(-1.0, 1.0)) * at_start
            tolerance = float(f"1e-{3 + k % 10}")
            writer.writerow(row_of(scene, h, delta_0, tolerance))
            print(f"\r{k + 1} of {COUNT}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)


if __name__ == "__main__":
    main()
