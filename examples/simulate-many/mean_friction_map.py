# %% [markdown]
# # A map of a million scenarios
#
# How does the mean friction depend on the stiffness of the contact and on the sliding velocity? Every point
# of the map is a simulation of FrictionContact.fmu in its periodic state. `simulate_many` runs them all at
# once: arrays broadcast as in NumPy, so a row of stiffnesses against a column of velocities is the whole map.

# %%
import argparse
import time
from pathlib import Path

import numpy as np

from frictioncontact import style
from frictioncontact.batch import simulate_many
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, SEPARATION, STIFFNESS_PRINTED
from tools.build import build_fmu
from tools.project import ROOT

parser = argparse.ArgumentParser(
    description="Mean friction against stiffness and velocity, a million scenarios."
)
parser.add_argument("--points", type=int, default=1000, help="along each axis of the map (1000)")
parser.add_argument("--quick", action="store_true", help="60 points along each axis")
parser.add_argument("--fmu", type=Path, help="use this FMU instead of building one")
parser.add_argument("--output", type=Path, default=ROOT / "build" / "examples" / "mean-friction-map.png")
options = parser.parse_args()
points = 60 if options.quick else options.points

# %% [markdown]
# The vibration moves the surfaces along the sliding and apart, with the paper's amplitude and about its
# identified phase: `kappa` says how often the bristle would saturate in one swing, `zeta` is the velocity
# over that of the vibration.

# %%
V_1 = 1.44  # m/s
R_q = 6e-6  # m, Table 1
kappa = np.geomspace(1e-2, 1e4, points)
zeta = np.geomspace(1e-2, 1.5, points)[:, None]
scenarios = {
    "V": zeta * V_1,
    "d": SEPARATION,
    "vibration.f": FREQUENCY,
    "vibration.V_1": V_1,
    "vibration.a_d": 0.18 * R_q,
    "vibration.phase_d": np.radians(225.0),
    "contact.stiffnessScale": kappa * 2 * np.pi * FREQUENCY * COULOMB_FORCE / V_1 / STIFFNESS_PRINTED,
    "F_C": COULOMB_FORCE,
}

# %% [markdown]
# `settled` starts each scenario where its state tends to after infinitely many periods of the vibration; one
# period more gives the mean. Work and heat of that period come along.

# %%
began, processor_began = time.perf_counter(), time.process_time()
results = simulate_many(
    scenarios,
    {"mean": "F_t_mean", "work": ("W_f", "change"), "heat": ("Q_f", "change")},
    settled=True,
    progress=True,
    fmu=options.fmu or build_fmu(),
)
mean = results["mean"] / COULOMB_FORCE
elapsed, processor = time.perf_counter() - began, time.process_time() - processor_began
print(f"{mean.size} scenarios in {elapsed:.1f} s, {processor:.1f} s of processor time")
print(f"mean friction from {mean.min():.3f} to {mean.max():.3f} F_C")

# %% [markdown]
# Below zero the vibration drives the sliding, as in an ultrasonic motor.

# %%
figure, axis = style.subplots(1, 1, size=(5.2, 4.4))
axis.set_xscale("log")
axis.set_yscale("log")
top = max(1.0, mean.max())
shown = axis.pcolormesh(kappa, zeta.ravel(), mean, cmap="RdBu_r", vmin=-top, vmax=top, rasterized=True)
levels = (-0.1, 0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.01)
lines = axis.contour(kappa, zeta.ravel(), mean, levels, colors="black", linewidths=0.6)
middles = [path.vertices[len(path) // 2] for path in lines.get_paths() if len(path)]
axis.clabel(lines, fontsize=8, manual=middles)  # away from the borders, which would cut them
axis.set_xlabel("κ = σ V$_1$ / (2π f F$_C$)")
axis.set_ylabel("ζ = V / V$_1$")
figure.colorbar(shown, label="mean F$_t$ / F$_C$")
options.output.parent.mkdir(parents=True, exist_ok=True)
style.save(figure, options.output)
print(f"wrote {options.output}")
