"""An ultrasonic motor: the contact point of a stator moves on an ellipse and drives a slider.

Its force against speed, its stall force and no-load speed against the stiffness of the contact, and one run
with a slider of 0.2 kg. Needs the package alone: python ultrasonic_motor.py
"""

from __future__ import annotations

import argparse
import sys
from functools import cache
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import frictioncontact as fc
from frictioncontact import style

MU, LOAD = 0.2, 100.0  # 1, N
LIMIT = MU * LOAD  # N
F, V_1, A_D = 40e3, 0.3, 1.5e-6  # Hz, m/s, m: frequency, tangential and normal swing of the stator
SCENE = {
    "friction.limit": "Load",
    "friction.mu": MU,
    "contact.input": "Load",
    "load": LOAD,
    "contact.model": "Mindlin",
    "vibration.f": F,
    "vibration.V_1": V_1,
    "vibration.a_d": A_D,
    "vibration.phase_d": np.pi,  # closest to the slider while it moves forward fastest
}
KAPPA = (1.0, 3.0, 10.0, 100.0)
MASS, STEP, DURATION = 0.2, 4 / F, 0.045  # kg, s (four periods), s
LOADED_AT, OPPOSING = 0.02, 4.0  # s, N: from then on a force opposes the motion
PICTURE = Path(__file__).resolve().parents[2] / "build" / "examples" / "ultrasonic-motor.png"


def stiffness(kappa: float) -> float:
    """Mean tangential stiffness [N/m] at kappa = sigma V_1 / (2 pi f mu load)."""
    return kappa * 2.0 * np.pi * F * LIMIT / V_1


def scene(kappa: float, law: str = "Dahl", **changed: float) -> dict[str, float | str]:
    """Start values of the contact; changed: those of the vibration, such as V_2 = 0.3."""
    moves = {f"vibration.{name}": value for name, value in changed.items()}
    return SCENE | {"friction.model": law, "contact.stiffnessScale": stiffness(kappa) / at_rest()} | moves


@cache
def at_rest() -> float:
    """Tangential stiffness [N/m] of the contact under its load, without vibration and with the factor 1."""
    contact = {name: SCENE[name] for name in ("contact.model", "contact.input", "load")}
    return float(fc.simulate(contact, stop=1e-6, step=1e-6, outputs=["sigma"])["sigma"].iloc[-1])


def thrust(start_values: dict[str, float | str], speed: np.ndarray) -> np.ndarray:
    """Mean force [N] on a slider that moves forward at speed [m/s].

    V is the velocity of the stator relative to the slider. Without the vibration it is -speed.
    """
    return np.asarray(fc.friction_law(start_values)(-np.asarray(speed)))


def speed_at(start_values: dict[str, float | str], opposing: float = 0.0) -> float:
    """Speed [m/s] at which the thrust is the opposing force [N]; of no load if that is 0."""
    return float(brentq(lambda v: float(thrust(start_values, v)) - opposing, 0.0, V_1, xtol=1e-9))


def power(start_values: dict[str, float | str], speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Output [W] and efficiency of the contact: the output over itself and the heat."""
    found = fc.simulate_many(
        start_values | {"V": -speeds},
        {"force": "F_t_mean", "heat": ("Q_f", "change")},
        settled=True,
    )
    output = found["force"] * speeds
    return output, output / (output + F * found["heat"])


def start_up(start_values: dict[str, float | str]) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and speeds [m/s] of a slider that starts from rest, in steps of four periods."""
    count = round(DURATION / STEP)
    speeds = np.zeros(count + 1)
    with fc.FrictionFmu(fc.FMU) as fmu, fmu.session(start_values | {"V": 0.0}) as contact:
        for k in range(count):
            contact.set("V", -float(speeds[k]))
            contact.step(STEP)
            opposing = OPPOSING if contact.time > LOADED_AT + 0.5 * STEP else 0.0
            speeds[k + 1] = speeds[k] + STEP * (contact.get("F_t_mean") - opposing) / MASS
    return STEP * np.arange(count + 1), speeds


def draw(path: Path) -> None:
    figure, (curves, stiff, run) = style.subplots(3, 1, size=(5.2, 9.0))
    speeds = np.linspace(0.0, 0.3, 121)
    colours = (style.SKY, style.BLUE, style.ORANGE, style.GREEN)
    for kappa, colour in zip(KAPPA, colours, strict=True):
        force = thrust(scene(kappa), speeds)
        label = f"κ = {kappa:g}, {1e-6 * stiffness(kappa):.0f} N/µm"
        curves.plot(1e3 * speeds, force, color=colour, lw=2.2, label=label)
    curves.plot(1e3 * speeds, thrust(scene(1.0, "Coulomb"), speeds), "--", color=style.BLACK, label="rigid")
    curves.set(
        title="Force over speed",
        xlabel="speed [mm/s]",
        ylabel="force that drives [N]",
        xlim=(0.0, 250.0),
        ylim=(0.0, 10.0),
    )
    curves.legend()

    kappas = np.geomspace(0.2, 1e3, 49)
    scenes = [scene(kappa) for kappa in kappas]
    stiffnesses = 1e-6 * stiffness(1.0) * kappas
    stall = [float(thrust(each, 0.0)) for each in scenes]
    stiff.semilogx(stiffnesses, stall, color=style.BLUE, lw=2.2)
    stiff.set(
        title="Stall force and no-load speed",
        xlabel="tangential stiffness of the contact [N/µm]",
        ylim=(0.0, 10.0),
    )
    stiff.set_ylabel("stall force [N]", color=style.BLUE)
    right = stiff.twinx()
    right.semilogx(stiffnesses, [1e3 * speed_at(each) for each in scenes], color=style.ORANGE, lw=2.2)
    right.set_ylabel("no-load speed [mm/s]", color=style.ORANGE)
    right.set_ylim(0.0, 200.0)
    right.grid(visible=False)

    for kappa, colour in zip(KAPPA[1:3], colours[1:3], strict=True):
        start_values = scene(kappa)
        time, speed = start_up(start_values)
        run.plot(1e3 * time, 1e3 * speed, color=colour, lw=2.2, label=f"κ = {kappa:g}")
        for opposing, begin, end in ((0.0, 0.0, LOADED_AT), (OPPOSING, LOADED_AT, DURATION)):
            level = 1e3 * speed_at(start_values, opposing)
            run.plot([1e3 * begin, 1e3 * end], [level, level], ":", color=style.BLACK, lw=1.4)
    run.plot([], [], ":", color=style.BLACK, label="force over speed")
    run.axvline(1e3 * LOADED_AT, color=style.GREY, lw=1.0, ls="--")
    run.text(1e3 * LOADED_AT + 0.3, 8.0, f"{OPPOSING:g} N oppose", fontsize=9)
    run.set(
        title=f"A slider of {MASS:g} kg starts, steps of {1e3 * STEP:g} ms",
        xlabel="time [ms]",
        ylabel="speed [mm/s]",
        xlim=(0.0, 1e3 * DURATION),
        ylim=(0.0, 200.0),
    )
    run.legend(ncols=3, loc="upper center")
    style.save(figure, path)


def table() -> str:
    """Stall force, no-load speed, largest output and its efficiency, against the stiffness."""
    rows = [
        "| κ | stiffness [N/µm] | stall force [N] | no-load speed [mm/s] | maximum output [W] "
        "| efficiency [%] |",
        "|---|---|---|---|---|---|",
    ]
    contacts = [(f"{kappa:g} | {1e-6 * stiffness(kappa):.0f}", scene(kappa)) for kappa in KAPPA]
    for name, start_values in [*contacts, ("rigid |", scene(1.0, "Coulomb"))]:
        fastest = speed_at(start_values)
        output, efficiency = power(start_values, np.linspace(0.0, fastest, 201)[1:-1])
        best = int(output.argmax())
        rows.append(
            f"| {name} | {float(thrust(start_values, 0.0)):.2f} | {1e3 * fastest:.1f} "
            f"| {output[best]:.3f} | {100.0 * efficiency[best]:.0f} |"
        )
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(prog="examples/ultrasonic-motor/run", description=__doc__)
    parser.add_argument("--output", type=Path, default=PICTURE, help="the picture")
    options = parser.parse_args()
    print(table())
    try:
        draw(options.output)
    except OSError as error:
        sys.exit(f"error: {options.output}: {error.strerror or error}")
    print(f"\nwrote {options.output}")


if __name__ == "__main__":
    main()
