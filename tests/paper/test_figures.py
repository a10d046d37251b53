"""The paper's figures: what is drawn is what the equations say."""

from __future__ import annotations

import numpy as np
import pytest

from frictioncontact.fmu import FrictionFmu
from workshop.figure import Figure, Level, Line
from workshop.paper import figures as paper_figures


@pytest.fixture(scope="module")
def figures(fmu: FrictionFmu) -> dict[str, Figure]:
    return {figure.key: figure for figure in (draw(fmu) for draw in paper_figures.FIGURES)}


def lines(figure: Figure, panel: int, label: str) -> Line:
    return next(i for i in figure.panels[panel].items if isinstance(i, Line) and i.label.startswith(label))


def level(figure: Figure, panel: int, label: str) -> float:
    return next(i.y for i in figure.panels[panel].items if isinstance(i, Level) and i.label.startswith(label))


def test_all_figures_that_the_model_can_draw(figures: dict[str, Figure]) -> None:
    assert list(figures) == [f"fig-{n:02}" for n in (2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13)]


@pytest.mark.parametrize("key", ["fig-02", "fig-03"])
@pytest.mark.parametrize("panel", [0, 1])
def test_eq_23_is_the_model_at_constant_velocity(figures: dict[str, Figure], key: str, panel: int) -> None:
    fmu, formula = (lines(figures[key], panel, label) for label in ("FMU", "Eq. 23"))
    assert fmu.y == pytest.approx(formula.y, abs=1e-4)
    assert fmu.y[-1] == pytest.approx(55.0 * (1.0 - np.exp(-6.0)), abs=1e-4)


def test_eq_25_is_not_the_model_when_the_contact_is_soft(figures: dict[str, Figure]) -> None:
    fmu, formula = (lines(figures["fig-04"], 1, label) for label in ("FMU", "Eq. 25"))
    assert np.max(np.abs(np.array(fmu.y) - np.array(formula.y))) > 30.0


def test_force_falls_with_separation_only_before_saturation(figures: dict[str, Figure]) -> None:
    fmu, formula = (lines(figures["fig-12"], 0, label) for label in ("FMU", "Eq. 23"))
    assert fmu.y == pytest.approx(formula.y, abs=1e-4)
    assert fmu.y[-1] < 20.0


def test_means_of_figures_9_11_13(figures: dict[str, Figure]) -> None:
    assert level(figures["fig-09"], 0, "FMU, mean") == pytest.approx(1.077066856, rel=1e-7)
    assert level(figures["fig-11"], 0, "FMU, mean") == pytest.approx(1.506797919, rel=1e-7)
    assert level(figures["fig-13"], 1, "FMU, mean") == pytest.approx(55.0, abs=1e-4)
    assert level(figures["fig-13"], 0, "its (max") == pytest.approx(47.89, abs=0.01)
