"""Map of the friction reduction from the results of a sweep over V and contact.stiffnessScale."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from frictioncontact import style
from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, STIFFNESS_PRINTED

V_1 = 1.44  # m/s


def draw(results: pd.DataFrame, path: Path) -> None:
    table = results.pivot(index="contact.stiffnessScale", columns="V", values="reduction")
    velocity = np.array(table.columns)
    kappa = np.array(table.index) * STIFFNESS_PRINTED * V_1 / (2 * np.pi * FREQUENCY * COULOMB_FORCE)
    figure, (field, cut) = style.subplots(2, 1, size=(5.2, 7.6))
    levels = np.linspace(0, 100, 11)
    shown = np.clip(table, 0.0, 100.0)  # where nothing is reduced, rounding leaves -1e-14
    filled = field.contourf(velocity / V_1, kappa, shown, levels, cmap="viridis")
    field.set_xscale("log")
    field.set_yscale("log")
    field.axvline(1.0, color="white", ls=":")
    field.set_xlabel("V / V$_1$")
    field.set_ylabel("κ = σ V$_1$ / (2π f F$_C$), stiffness of the contact")
    field.set_title("Friction reduction [%]")
    figure.colorbar(filled, ax=field)
    colours = (style.SKY, style.BLUE, style.GREEN, style.PINK)
    for wanted, colour in zip((0.01, 0.3, 3.0, 100.0), colours, strict=True):
        row = int(np.abs(np.log(kappa / wanted)).argmin())
        cut.semilogx(velocity / V_1, table.iloc[row], color=colour, label=f"κ = {kappa[row]:.2g}")
    fine = np.geomspace(velocity[0], velocity[-1], 400) / V_1
    coulomb = 100 * (1 - 2 / np.pi * np.arcsin(np.minimum(fine, 1)))
    cut.semilogx(fine, coulomb, "--", color=style.BLACK, lw=1, label="Coulomb, κ → ∞")
    phase = np.linspace(0, 2 * np.pi, 4001)[:-1]
    soft = [100 * (1 - z / np.abs(z + np.cos(phase)).mean()) for z in fine]
    cut.semilogx(fine, soft, ":", color=style.BLACK, lw=1.2, label="κ → 0")
    cut.set_xlabel("V / V$_1$")
    cut.set_ylabel("friction reduction [%]")
    cut.legend()
    style.save(figure, path)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    draw(pd.read_parquet(folder / "results.parquet"), folder / "reduction.png")
    print(f"wrote {folder / 'reduction.png'}")
