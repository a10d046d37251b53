"""The paper's figures: what is drawn is what the equations say."""

from __future__ import annotations

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu
from workshop.report import paper
from workshop.report.figure import Figure, Level, Line


@pytest.fixture(scope="module")
def figures(fmu: FrictionFmu) -> dict[str, Figure]:
    return {figure.key: figure for figure in (draw(fmu) for draw in paper.FIGURES)}


def drawn(figure: Figure, panel: int, label: str) -> np.ndarray:
    kinds = (Line, Level)
    items = figure.panels[panel].items
    return np.asarray(next(i.y for i in items if isinstance(i, kinds) and i.label.startswith(label)))


def test_eq_23_is_the_model_at_constant_velocity(figures: dict[str, Figure]) -> None:
    """And not while V vibrates over a soft contact; the force follows d before it saturates only."""
    for key, panel in (("fig-02", 0), ("fig-02", 1), ("fig-03", 0), ("fig-03", 1), ("fig-12", 0)):
        fmu, formula = (drawn(figures[key], panel, label) for label in ("FMU", "Eq. 23"))
        assert fmu == pytest.approx(formula, abs=1e-4), key
        assert fmu[-1] == pytest.approx(55.0 * (1.0 - np.exp(-6.0)), abs=1e-4) or (
            key == "fig-12" and fmu[-1] < 20
        )
    fmu, formula = (drawn(figures["fig-04"], 1, label) for label in ("FMU", "Eq. 25"))
    assert np.max(np.abs(fmu - formula)) > 30.0


def test_means_of_figure_13(figures: dict[str, Figure]) -> None:
    assert drawn(figures["fig-13"], 1, "FMU, mean") == pytest.approx(55.0, abs=1e-4)
    assert drawn(figures["fig-13"], 0, "its (max") == pytest.approx(47.89, abs=0.01)
