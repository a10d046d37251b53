"""The mass inside: what its page says, in every tool that it names."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tools.project import ROOT

pytest.importorskip("libcosimpy", reason="libcosimpy is not installed")
sys.path.append(str(ROOT / "examples" / "mass-inside"))
import mass_inside

PAGE = (ROOT / "examples" / "mass-inside" / "README.md").read_text(encoding="utf-8")


def test_the_errors_of_the_pulled_mass_are_the_page_s(fmu_path: Path, tmp_path: Path) -> None:
    linear, held = (float(x) for x in re.findall(r"\| (?:linear|held) \| ([\d.]+) % \|", PAGE))
    assert 100.0 * mass_inside.error(mass_inside.by_package(fmu_path)) == pytest.approx(linear, rel=0.05)
    for found in (mass_inside.by_fmpy(fmu_path), mass_inside.by_command(fmu_path, tmp_path)):
        assert 100.0 * mass_inside.error(found) == pytest.approx(held, rel=0.02)


def test_the_slider_comes_to_the_velocity_of_the_page(fmu_path: Path, tmp_path: Path) -> None:
    """In both importers, where the mean friction is the pull."""
    (stated, by_law) = (1e-3 * float(x) for x in re.findall(r"pull: ([\d.]+) mm/s, and ([\d.]+) by", PAGE)[0])
    ssp = mass_inside.make_ssp(fmu_path, tmp_path)
    for run in (mass_inside.run_libcosim, mass_inside.run_fmpy):
        step = mass_inside.H if run is mass_inside.run_fmpy else round(1e9 * mass_inside.H)
        v, force = mass_inside.final(run(ssp, step, mass_inside.SLIDES, mass_inside.SIGNALS))
        assert v == pytest.approx(stated, rel=2e-4) and force == pytest.approx(15.0, rel=1e-4)
    assert mass_inside.final_velocity() == pytest.approx(by_law, rel=2e-4)
