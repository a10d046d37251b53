"""A mass and a stuck contact that exchange values: the edges of stability that docs/machine.md promises.

They are measured with the FMU in a master written here, and held against eigenvalues where it is one's turn.
"""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from frictioncontact.advice import command as advise
from frictioncontact.advice.stuck_mass import (
    GAUSS_SEIDEL,
    JACOBI,
    LARGEST_STEP,
    LINEAR,
    MASTERS,
    REREAD,
    advice,
    damping_range,
    least_damping,
)
from frictioncontact.command import main
from frictioncontact.fmu import FrictionFmu
from workshop.project import ROOT

M, SIGMA = 1.0, 1e6
TIME = math.sqrt(M / SIGMA)
COUNT = 600  # steps
GUIDE = (ROOT / "docs" / "machine.md").read_text(encoding="utf-8").partition("## Another mass")[2]
TITLES = {  # of the rows in docs/machine.md
    JACOBI: "Jacobi, held values",
    REREAD: "Jacobi that reads",
    LINEAR: "Jacobi with input and output derivatives",
    GAUSS_SEIDEL: "Gauss-Seidel",
}


def grows(
    fmu: FrictionFmu, master: str, H: float, sigma_1: float, c: float = 0.0, output: str = "F_t"
) -> bool:
    """Whether the mass, which starts at 1 um/s from rest of the contact, swings ever more.

    c damps it outside. By more than 1 % in 200 steps: an undamped swing's samples miss its peak by less. The
    law is ElasticPlastic far below its limit, which sticks truly; the mass is integrated exactly.
    """
    x = c * H / M
    kept = math.exp(-x)
    by_force = -(-math.expm1(-x) / c if c else H / M)
    by_rate = -0.5 * H**2 / M
    start = {
        "friction.model": "ElasticPlastic",
        "contact.model": "Constant",
        "contact.sigma": SIGMA,
        "friction.sigma_1": sigma_1,
        "F_C": 1e9 * SIGMA * TIME * 1e-6,
        "V": 1e-6,
    }
    v = 1e-6
    speeds = [v]
    with fmu.session(start) as session:
        while len(speeds) < COUNT and abs(v) < 1e-2:  # far below where the bristle slips
            if master != JACOBI:
                session.set("V", v)
            force, rate = session.get(output), 0.0
            session.set("V", v)
            if master == LINEAR:
                session.set_rates(V=-force / M)
                rate = session.force_rate()
            v = kept * v + by_force * force + by_rate * rate
            if master == GAUSS_SEIDEL:
                session.set("V", v)
            session.step(H)
            speeds.append(v)
    size = np.abs(speeds)
    return len(size) < COUNT or bool(size[500:].max() > 1.01 * size[300:400].max())


def promised(master: str, H: float) -> tuple[float, float]:
    """The edges [N s/m] by the formulas in the table's row."""
    row = re.search(rf"^\| {re.escape(TITLES[master])}[^|]*\|([^|]*)\|([^|]*)\|", GUIDE, re.MULTILINE)
    edges = []
    for formula in row.groups():
        for sign, python in {"·": "*", "²": "**2", "⁴": "**4", "√": "sqrt", "−": "-"}.items():
            formula = formula.replace(sign, python)
        names = {"H": H, "m": M, "sigma": SIGMA, "h": H / TIME, "sqrt": math.sqrt, "min": min}
        edges.append(eval(formula.split(", about")[0].strip(), names))
    return edges[0], edges[1]


@pytest.mark.parametrize("fraction", [0.3, 0.95])
@pytest.mark.parametrize("master", MASTERS)
def test_the_fmu_turns_unstable_at_the_edges_of_the_table(
    fmu: FrictionFmu, master: str, fraction: float
) -> None:
    H = fraction * LARGEST_STEP[master] * TIME
    low, high = promised(master, H)
    assert damping_range(M, SIGMA, master, H) == pytest.approx((low, high), rel=1e-9)
    assert grows(fmu, master, H, 1.03 * high)
    assert not grows(fmu, master, H, 0.97 * high)
    assert not grows(fmu, master, H, 1.03 * low)
    assert low == 0.0 or grows(fmu, master, H, 0.97 * low)


@pytest.mark.parametrize("master", [JACOBI, GAUSS_SEIDEL])
def test_the_edges_of_the_mean_force(fmu: FrictionFmu, master: str) -> None:
    """They lie H sigma / 2 higher, as docs/machine.md and the advice say."""
    H = 0.5 * LARGEST_STEP[master] * TIME
    low, high = (edge + H * SIGMA / 2 for edge in promised(master, H))
    assert grows(fmu, master, H, 1.03 * high, output="F_t_mean")
    assert not grows(fmu, master, H, 0.97 * high, output="F_t_mean")
    assert not grows(fmu, master, H, 1.03 * low, output="F_t_mean")
    assert grows(fmu, master, H, 0.97 * low, output="F_t_mean")
    assert f"F_t_mean, add H sigma / 2 = {H * SIGMA / 2:.6g} N s/m" in advice(M, SIGMA, master, H)[0]


@pytest.mark.parametrize("master", MASTERS)
def test_the_largest_step_is_that_of_the_table(fmu: FrictionFmu, master: str) -> None:
    row = re.search(rf"^\| {re.escape(TITLES[master])}.*\| (\S+) √\(m/sigma\) \|$", GUIDE, re.MULTILINE)
    limit = float(row[1])
    assert limit == pytest.approx(LARGEST_STEP[master], rel=1e-3)
    H = 0.97 * limit * TIME
    assert not grows(fmu, master, H, math.fsum(damping_range(M, SIGMA, master, H)) / 2)
    H = 1.03 * limit * TIME
    assert damping_range(M, SIGMA, master, H) is None
    assert all(grows(fmu, master, H, x * M / H) for x in np.linspace(0.0, 5.0, 25))


@pytest.mark.parametrize("master", MASTERS)
def test_the_advised_damping_is_stable_and_hardly_more_than_the_least(fmu: FrictionFmu, master: str) -> None:
    for fraction in (0.1, 0.999):
        H = fraction * LARGEST_STEP[master] * TIME
        advised = least_damping(M, SIGMA, master, H)
        assert not grows(fmu, master, H, advised)
        assert advised <= 1.1001 * promised(master, H)[0]


def test_damping_outside_sets_the_held_step(fmu: FrictionFmu) -> None:
    """H < c / sigma."""
    H = 0.1 * TIME
    assert not grows(fmu, JACOBI, H, 0.0, c=1.03 * H * SIGMA)
    assert grows(fmu, JACOBI, H, 0.0, c=0.97 * H * SIGMA)


def test_the_advice_can_be_pasted(fmu: FrictionFmu, capsys: pytest.CaptureFixture[str]) -> None:
    """And at break-away F_t is the static friction and sigma_1 V, as it says."""

    def told(master: str, *words: str) -> str:
        scene = [f"--set={word}" for word in ("contact.model=Constant", "contact.sigma=1e6", *words)]
        main(advise, ["--mass", "1", "--step", "1e-4", "--master", master, *scene])
        return capsys.readouterr().out

    said = told(JACOBI)
    assert not grows(fmu, JACOBI, 1e-4, float(said.rsplit("friction.sigma_1", 1)[1]))
    assert told(GAUSS_SEIDEL, "friction.sigma_1=5").endswith("friction.sigma_1 0\n")
    assert "At break-away F_t exceeds the static friction by sigma_1 V, 111.123 N for" in said
    sticking = {
        "friction.model": "ElasticPlastic", "friction.staticRatio": 1.5, "friction.sigma_1": 111.123,
        "contact.model": "Constant", "contact.sigma": 1e6, "V": 0.1,
    }  # fmt: skip
    with fmu.session(sticking) as session:
        session.step(0.999 * 1.5 * 55.0 / 1e6 / 0.1)
        assert session.get("F_t") == pytest.approx(0.999 * 1.5 * 55.0 + 111.123 * 0.1, rel=1e-6)


def test_a_step_that_nothing_makes_stable_is_said() -> None:
    assert "No friction.sigma_1 makes a step" in advice(M, SIGMA, JACOBI, 0.6 * TIME)[0]
