"""The pictures of docs/physics.md that need the FMU alone: an open contact and static friction."""

from pathlib import Path

import numpy as np

from frictioncontact import style
from frictioncontact.fmu import FrictionFmu, Value, simulate
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY

MU = 0.176
LIFTED: dict[str, Value] = {
    "friction.limit": "Load",
    "friction.mu": MU,
    "contact.input": "Load",
    "contact.model": "Constant",
    "contact.sigma": 1e5,
}
# s, N, m/s: corners of the lines along which the tool is pressed, slides, is lifted off and set down again.
CORNERS = np.array([0.0, 0.1, 0.12, 0.5, 0.6, 0.7, 0.8, 1.2])
LOAD = np.array([0.0, 100.0, 100.0, 100.0, 0.0, 0.0, 100.0, 100.0])
SLIDING = np.array([0.0, 0.0, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3])
FINE, COARSE = 1e-3, 20e-3  # s: communication steps with linear and with held inputs

RATIO, V_S, STIFFNESS, LOADED = 1.5, 0.01, 2.5e6, 77.0  # 1, m/s, N/m, N
STATIC: dict[str, Value] = {
    "friction.model": "ElasticPlastic",
    "friction.staticRatio": RATIO,
    "friction.V_S": V_S,
    "F_C": COULOMB_FORCE,
    "contact.model": "Constant",
    "contact.sigma": STIFFNESS,
    "vibration.f": FREQUENCY,
}


def open_contact(fmu: FrictionFmu, path: Path) -> None:
    """Load, sliding velocity, force and heat of a tool that is set down, lifted off and set down again."""
    heights = {"height_ratios": (1.0, 0.7, 1.7, 1.2)}
    figure, panels = style.subplots(4, 1, size=(5.2, 7.4), sharex=True, **heights)
    load, sliding, force, heat = panels

    def run(law: str, step: float, linear: bool) -> dict[str, np.ndarray]:
        count = round(CORNERS[-1] / step)
        time = step * np.arange(count + 1)
        inputs = {"load": np.interp(time, CORNERS, LOAD), "V": np.interp(time, CORNERS, SLIDING)}
        scene = LIFTED | {"friction.model": law}
        return simulate(fmu, scene, step, count, inputs, linear, outputs=("F_t", "Q_f"))

    load.plot(CORNERS, LOAD, color=style.BLACK)
    sliding.plot(CORNERS, 1e3 * SLIDING, color=style.BLACK)
    limit = MU * LOAD
    force.fill_between(CORNERS, limit, color=style.LIGHT, alpha=0.45, lw=0, label="up to μ load")
    for law, colour in (("ElasticPlastic", style.BLUE), ("Dahl", style.ORANGE)):
        ramp, held = run(law, FINE, True), run(law, COARSE, False)
        for axes, name, scale in ((force, "F_t", 1.0), (heat, "Q_f", 1e3)):
            axes.plot(ramp["time"], scale * ramp[name], color=colour, lw=2.2, label=law)
            axes.plot(held["time"], scale * held[name], ".", color=colour, ms=5, alpha=0.6)
    force.plot([], [], ".", color=style.GREY, label="held over 20 ms")
    for axes in panels:
        axes.axvspan(0.6, 0.7, color=style.AMBER, alpha=0.25, lw=0)
    load.text(0.65, 50.0, "open", ha="center", va="center")
    load.set(ylabel="load [N]", title="A tool is set down, lifted off and set down again")
    sliding.set(ylabel="V [mm/s]", yticks=[0, 1], ylim=(-0.1, 1.2))
    force.set(ylabel="force $F_t$ [N]", ylim=(-0.5, 24.0), yticks=[0, 5, 10, 15])
    force.legend(loc="upper center", ncols=2)
    heat.set(ylabel="heat $Q_f$ [mJ]", xlabel="time [s]", xlim=(0.0, CORNERS[-1]))
    style.save(figure, path)


def stribeck(V: np.ndarray) -> np.ndarray:
    """Friction that slides, over F_C."""
    return 1.0 + (RATIO - 1.0) * np.exp(-((V / V_S) ** 2))


def bound_with_total_velocity(V_1: np.ndarray, periods: int = 5, steps: int = 4000) -> np.ndarray:
    """Mean force [N] over the last period, stuck at 77 N, if vibration lowers the bound of what sticks.

    Plain steps in time: the force follows the path and is cut off at F_C s(V) of that instant.
    """
    dt = 1.0 / (FREQUENCY * steps)
    F, total = np.full(len(V_1), LOADED), np.zeros(len(V_1))
    for k in range(periods * steps):
        V = V_1 * np.cos(2.0 * np.pi * (k + 0.5) / steps)
        bound = COULOMB_FORCE * stribeck(V)
        F = np.clip(F + STIFFNESS * V * dt, -bound, bound)
        if k >= (periods - 1) * steps:
            total += F
    return total / steps


def vibrated(fmu: FrictionFmu, V_1: float) -> float:
    """Mean force [N] of the FMU, loaded to 77 N and held there, once settled."""
    scene = STATIC | {"V": 0.0, "vibration.V_1": V_1, "delta_0": LOADED / STIFFNESS}
    with fmu.session(scene) as session:
        return session.get("F_t_settled")


def break_away(fmu: FrictionFmu, V: float, steps: int = 2000) -> float:
    """Largest force [N] of the FMU that V [m/s] moves from rest, over 1.2 times the way to break-away."""
    step = 1.2 * RATIO * COULOMB_FORCE / STIFFNESS / V / steps
    return max(simulate(fmu, STATIC | {"V": V}, step, steps, outputs=("F_t",))["F_t"])


def static_friction(fmu: FrictionFmu, path: Path) -> None:
    """What a vibration leaves of static friction, and the force at which a steady motion breaks away."""
    figure, (shaken, moved) = style.subplots(2, 1, size=(5.2, 6.4))
    V_1 = np.geomspace(1e-3, 0.5, 200)
    now = [vibrated(fmu, each) for each in V_1]
    V = np.geomspace(1e-5, 1.0, 26)
    held = [break_away(fmu, each) / COULOMB_FORCE for each in V]
    fine = np.geomspace(V[0], V[-1], 400)
    for axes, x, y, other_x, other_y in (
        (shaken, V_1, now, V_1, bound_with_total_velocity(V_1)),
        (moved, V, held, fine, stribeck(fine)),
    ):
        axes.semilogx(x, y, color=style.BLUE, lw=2.4, label="static while it sticks: the FMU")
        axes.semilogx(other_x, other_y, "--", color=style.ORANGE, label="bound with the total V")
    shaken.text(0.24, 66.0, "its swing reaches\n1.5 $F_C$ = 82.5 N", ha="right", va="center", fontsize=9)
    (fallen,) = bound_with_total_velocity(np.array([0.02]))
    shaken.plot(0.02, fallen, "o", color=style.ORANGE)
    shaken.text(0.023, fallen + 1.5, f"{fallen:.1f} N", fontsize=9)
    shaken.set(title="Loaded to 77 N (1.4 $F_C$), then vibrated at 20 kHz", ylabel="mean force [N]")
    shaken.set(xlabel="amplitude $V_1$ of the vibration [m/s]", xlim=V_1[[0, -1]], ylim=(45.0, 85.0))
    moved.set(title="Moved from rest at a constant V", ylabel="break-away force over $F_C$")
    moved.set(xlabel="V [m/s]", xlim=V[[0, -1]], ylim=(0.9, 1.6))
    figure.legend(*shaken.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    style.save(figure, path)
