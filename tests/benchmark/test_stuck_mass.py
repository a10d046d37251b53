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
from tools.project import ROOT

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


def grows(fmu: FrictionFmu, master: str, H: float, sigma_1: float, output: str = "F_t") -> bool:
    """Whether the mass, which starts at 1 um/s from rest of the contact, swings ever more.

    By more than 1 % in 200 steps: an undamped swing's samples miss its peak by less. ElasticPlastic sticks
    truly far below its limit; the mass is integrated exactly.
    """
    start = {
        "friction.model": "ElasticPlastic", "contact.model": "Constant", "contact.sigma": SIGMA,
        "friction.sigma_1": sigma_1, "F_C": 1e9 * SIGMA * TIME * 1e-6, "V": 1e-6,
    }  # fmt: skip
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
            v -= H / M * (force + 0.5 * H * rate)
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


@pytest.mark.parametrize("fraction", [0.1, 0.3, 0.95, 0.999])
@pytest.mark.parametrize("master", MASTERS)
def test_the_fmu_turns_unstable_at_the_edges_of_the_table(
    fmu: FrictionFmu, master: str, fraction: float
) -> None:
    """What is advised lies a tenth above the lower one, or half-way between both."""
    H = fraction * LARGEST_STEP[master] * TIME
    low, high = promised(master, H)
    assert damping_range(M, SIGMA, master, H) == pytest.approx((low, high), rel=1e-9)
    assert least_damping(M, SIGMA, master, H) == pytest.approx(min(1.1 * low, math.sqrt(low * high)))
    if fraction in (0.3, 0.95):
        check_edges(fmu, master, H, low, high)


def check_edges(
    fmu: FrictionFmu, master: str, H: float, low: float, high: float, output: str = "F_t"
) -> None:
    assert grows(fmu, master, H, 1.03 * high, output)
    assert not grows(fmu, master, H, 0.97 * high, output)
    assert not grows(fmu, master, H, 1.03 * low, output)
    assert low == 0.0 or grows(fmu, master, H, 0.97 * low, output)


@pytest.mark.parametrize("master", [JACOBI, GAUSS_SEIDEL])
def test_the_edges_of_the_mean_force(fmu: FrictionFmu, master: str) -> None:
    """They lie H sigma / 2 higher, as docs/machine.md and the advice say."""
    H = 0.5 * LARGEST_STEP[master] * TIME
    low, high = (edge + H * SIGMA / 2 for edge in promised(master, H))
    check_edges(fmu, master, H, low, high, "F_t_mean")
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
    words, values = advice(M, SIGMA, master, H)
    assert "No friction.sigma_1 makes a step" in words and f"body.m = {M:g}" in words and not values
    assert all(grows(fmu, master, H, x * M / H) for x in np.linspace(0.0, 5.0, 25))


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
