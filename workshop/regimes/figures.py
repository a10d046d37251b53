"""Figures of the regimes: mean friction, sensitivities, friction reduction, and which model is enough."""

import math

import numpy as np

from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, IDENTIFIED, PRINTED, TABLE_2
from frictioncontact.style import AMBER, BLACK, BLUE, GREEN, ORANGE, PINK, RED, SKY
from workshop.figure import Classes, Figure, Line, Map, Panel
from workshop.regimes.mean import (
    REGIMES,
    Probe,
    Regime,
    coulomb_limit,
    coulomb_sensitivity,
    on_map,
    regime_map,
    soft_limit,
    soft_sensitivity,
)
from workshop.validate.measurements import sliding

ALPHA = 1.1 / 6.0  # a_d / R_q in the paper
PHASE = math.radians(225.0)  # about the identified phase
KAPPA, ZETA = "κ = σ V_1 / (2π f F_C)", "ζ = V / V_1"
SYMBOLS = {"V": "V", "V_1": "V_1", "d": "d", "a_d": "a_d", "phase_d": "phase", "E": "E", "F_C": "F_C"}
STEPS_FULL, STEPS_QUICK = 49, 17
DRY_STIFFNESS = 7.76e6  # N/m, of the dry rows in docs/measured-parameters.md


def grids(quick: bool) -> tuple[np.ndarray, np.ndarray]:
    """kappa and zeta of the maps."""
    n = STEPS_QUICK if quick else STEPS_FULL
    return np.geomspace(1e-2, 1e4, n), np.geomspace(1e-2, 1.5, n)


def means(probe: Probe, quick: bool) -> Figure:
    """Mean friction over kappa and zeta without and with normal vibration, and cuts against the limits."""
    kappas, zetas = grids(quick)
    levels = (0.0, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8)
    panels = [
        Panel(title, KAPPA, ZETA, [Map(kappas, zetas, z, "mean F_t / F_C", 0.0, 1.0, levels)], True, True)
        for title, z in (
            ("d constant", probe.mean(on_map(kappas, zetas))),
            ("a_d / R_q = 0.18, phase 225°", probe.mean(on_map(kappas, zetas, ALPHA, PHASE))),
        )
    ]
    cuts = []
    fine = np.linspace(0.005, 1.5, 120)
    for kappa, colour in zip((0.3, 1.0, 3.0, 10.0), (SKY, GREEN, AMBER, PINK), strict=True):
        cuts.append(Line(fine, probe.mean(Regime(kappa, fine)), f"FMU, κ = {kappa:g}", colour))
    cuts += [
        Line(fine, [soft_limit(z) for z in fine], "κ → 0: ζ / mean |ζ + cos|", BLUE, "dashed"),
        Line(fine, [coulomb_limit(z) for z in fine], "κ → ∞: (2/π) asin ζ (Coulomb)", BLACK, "dashed"),
    ]
    panels.append(Panel("Cuts at d constant", ZETA, "mean F_t / F_C", cuts, y_range=(0.0, 1.05)))
    caption = (
        "Mean friction in the periodic state. Stiff contacts tend to Coulomb's mean: at κ = 100 within "
        "0.001 F_C for ζ = 0.3, but not near ζ = 1; with d moving this much only above 3000. Soft ones, "
        "below 0.1, keep a nearly constant deflection and have a limit of their own: π²/4 times Coulomb's "
        "mean at small ζ. Inside the line 0 the mean is negative: the vibration drives the sliding. Beyond "
        "ζ = 1 nothing reverses and, with d constant, the mean is F_C."
    )
    return Figure("mean", "Mean friction over the regimes", caption, panels, 3, (15.0, 4.9))


def sensitivity_cuts(probe: Probe, quick: bool) -> Figure:
    """Along kappa at one zeta, against the closed-form limits at both ends."""
    kappas = np.geomspace(1e-3, 1e5, 33 if quick else 97)
    zeta = 0.3
    ends = np.array([1e-3, 1e-2]), np.array([1e4, 1e5])
    groups = (("V", "V_1", "F_C"), ("a_d", "phase_d", "E"), ("d",))
    colours = (BLUE, ORANGE, GREEN)
    panels = []
    for names in groups:
        items = []
        for name, colour in zip(names, colours, strict=False):
            values = probe.sensitivity(Regime(kappas, zeta, ALPHA, PHASE), name)
            items.append(Line(kappas, values, f"FMU, to {SYMBOLS[name]}", colour))
            limits = soft_sensitivity(zeta, name, ALPHA, PHASE), coulomb_sensitivity(zeta, name)
            for x, y in zip(ends, limits, strict=True):
                items.append(Line(x, [y, y], "", BLACK, "dashed", 2.4))
        items.append(Line([1.0], [np.nan], "limits in closed form", BLACK, "dashed", 2.4))
        title = "To " + ", ".join(SYMBOLS[name] for name in names)
        panels.append(Panel(title, KAPPA, "of F_C per 100 % or rad", items, True))
    caption = (
        "The same along κ at ζ = 0.3. The dashed ends are the limits: Coulomb's (2/π) asin ζ to the right, "
        "where only V, V_1 and F_C matter, and the soft limit ζ ⟨σ⟩ / ⟨σ |ζ + cos|⟩ to the left, where the "
        "phase matters and the stiffness no more."
    )
    return Figure("sensitivity-cuts", "Sensitivities against their limits", caption, panels, 3, (15.0, 4.9))


def regimes(probe: Probe, quick: bool) -> Figure:
    """Which model is enough, over kappa and zeta, for three amplitudes of the separation."""
    n = 21 if quick else 61
    kappas, zetas = np.geomspace(1e-2, 1e7, n), np.geomspace(1e-3, 1.5, n)
    panels = []
    amplitudes = {0.0: "d constant", 0.02: "a_d / R_q = 0.02", ALPHA: "a_d / R_q = 0.18 (paper)"}
    for alpha, words in amplitudes.items():
        z = regime_map(probe, kappas, zetas, alpha, phases=8 if quick else 12)
        items = [Classes(kappas, zetas, z, REGIMES, (SKY, GREEN, AMBER, PINK)), *_table_2_points()]
        items += [] if alpha else [_dry_rows()]
        panels.append(Panel(words, KAPPA, ZETA, items, True, True))
    caption = (
        "The simplest simplification of Dahl's law whose mean is within 1 % of F_C of Dahl's at every phase "
        "of the separation. Where the mean may be negative, some phase drives the sliding. Marked: row 3 of "
        "Table 2 at the printed parameters (κ = 1.2e6, ζ = 0.0035) and as identified (κ = 0.53, ζ = 0.35), "
        "and the dry rows of Luo 2024, of which Dahl's law itself gives 1/110 to 1/4."
    )
    title = "Dahl's law: which simplification is within 1 % of F_C"
    return Figure("regimes", title, caption, panels, 3, (15.0, 5.6))


def _dry_rows() -> Line:
    """The measured rows, at the stiffness of the fit with ElasticPlastic."""
    rows = sliding("dry")
    kappas = DRY_STIFFNESS * rows.V_1 / (2.0 * math.pi * rows.f * rows.without)
    return Line(kappas, rows.V / rows.V_1, "dry rows, measured", RED, markers=True)


def _table_2_points() -> list[Line]:
    points = []
    for parameters, colour in ((PRINTED, BLACK), (IDENTIFIED, ORANGE)):
        V_1 = TABLE_2[2].V_1
        kappa = parameters.stiffness * V_1 / (2.0 * math.pi * FREQUENCY * COULOMB_FORCE)
        label = f"row 3 of Table 2, {parameters.name}"
        points.append(Line([kappa], [parameters.V / V_1], label, colour, markers=True))
    return points


def _limits(zetas: np.ndarray) -> list[Line]:
    """Of the friction reduction: of stiff and of soft contacts."""
    return [
        Line(zetas, [100.0 * (1.0 - limit(z)) for z in zetas], label, colour, "dashed")
        for limit, label, colour in (
            (coulomb_limit, "Coulomb limit, κ → ∞", BLACK),
            (soft_limit, "soft limit, κ → 0", BLUE),
        )
    ]


def reduction(probe: Probe, quick: bool) -> Figure:
    """Friction reduction over V / V_1 with the limits."""
    zetas = np.geomspace(1e-3, 2.0, 60 if quick else 160)
    coulomb, soft = _limits(zetas)
    lines = [coulomb]
    for kappa, colour in ((10.0, AMBER), (3.0, GREEN), (1.0, SKY)):
        values = 100.0 * (1.0 - probe.mean(Regime(kappa, zetas)))
        lines.append(Line(zetas, values, f"FMU, κ = {kappa:g}", colour))
    lines += [soft, Line([0.005 / 1.44], [51.0], "Table 2, row 3, as printed", ORANGE, markers=True)]
    y, limits = "friction reduction [%]", (0.0, 105.0)
    title = "Tangential vibration, d constant"
    model = Panel(title, "V / V_1", y, lines, True, y_range=limits, x_range=(1e-3, 2.0))
    caption = (
        "With a constant separation every stiffness lies between the two dashed limits. The printed V / V_1 "
        "of Table 2 is 0.0035: there every stiffness gives at least 99.4 %, not 51 %."
    )
    title = "Friction reduction against the velocity ratio"
    return Figure("reduction", title, caption, [model], 1, (6.4, 5.0))
