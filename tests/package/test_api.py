"""fc.identify and fc.advise: what the commands print, from Python values, and one line for what is wrong."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from matplotlib import rcParams
from matplotlib.figure import Figure

import frictioncontact as fc
from frictioncontact.advice import command as advise_command
from frictioncontact.command import main
from frictioncontact.identification import command as identify_command
from tools.project import ROOT

DRY = ROOT / "data" / "dry.csv"
ROWS = {"V": [0.02, 0.04, 0.05], "vibration.V_1": [0.5] * 3, "F_t_mean": [31.0, 33.0, 0.0]}
LAW = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}


@pytest.fixture(scope="module")
def dry(fmu_path: Path) -> fc.Identification:
    return fc.identify(DRY, fit="contact.sigma", start=LAW, fmu=fmu_path)


def test_it_prints_and_draws_what_the_command_does(
    dry: fc.Identification, fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [word for name, value in LAW.items() for word in ("--set", f"{name}={value}")]
    options = ["--fit", "contact.sigma", "--output", str(tmp_path), "--fmu", str(fmu_path)]
    main(identify_command, [str(DRY), *words, *options])
    printed = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert printed[:-1] == [line.rstrip() for line in str(dry).splitlines()]
    assert (tmp_path / "identify.png").stat().st_size > 10_000 and (tmp_path / "identify.svg").is_file()


def test_it_draws_and_leaves_the_user_s_settings(dry: fc.Identification) -> None:
    before = dict(rcParams)
    figure = dry.plot()
    assert isinstance(figure, Figure) and len(figure.axes) == 2
    assert dict(rcParams) == before


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"data": {"V [m/s]": [1.0]}}, "data: column 'F_t_mean [N]' is missing"),
        ({"fit": ["F_t"]}, "F_t can't be fitted; did you mean F_C? these can: V, d"),
        ({"fit": []}, "fit: names no parameter"),
        ({"fit": {"F_C": (1.0, 2.0, 3.0)}}, "F_C = (1.0, 2.0, 3.0): a range is (low, high)"),
        ({"uncertain": {"speed": 1.0}}, "the uncertainty of speed: speed is no variable that a file may"),
        ({"nuisance": ["gain"]}, "nuisance gain: must be one of offset, drift, delay, sign"),
        ({"nuisance": "delay"}, "nuisance delay: is for a series, with a column 'time [s]'"),
        ({"data": ROWS, "fit": ["F_C", "vibration.V_1"]}, "vibration.V_1 is a column of the measurements"),
        ({"data": ROWS, "fit": ["F_C", "contact.sigma", "d", "E"]}, "3 rows can't give 4 parameters"),
        ({"data": ROWS, "fit": {"F_C": -3}}, "F_C = -3 N must be from 1e-12"),
        ({"data": ROWS, "fit": "F_C", "start": {"F_C": 50}}, "F_C is given as a start value"),
        ({"data": ROWS, "fit": "F_C", "start": {"vibration.a_d": 20e-6}}, "row 1: "),
        ({"data": ROWS, "fit": "F_C", "uncertain": {"F_t_mean": "5%"}}, "the uncertainty of F_t_mean: row 3"),
        ({"start": {"contact.model": "Mindlin"}}, "contact.sigma can't be fitted: contact.sigma has no"),
    ],
)
def test_wrong_fits_are_one_line(fmu_path: Path, arguments: dict, message: str) -> None:
    with pytest.raises(fc.UserError, match="^" + re.escape(message)):
        fc.identify(**{"data": DRY, "fit": "contact.sigma", "start": LAW, "fmu": fmu_path, **arguments})


def test_advice_is_what_the_command_prints(fmu_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = {"V": 0.05, "vibration.V_1": 1.44, "friction.model": "LuGre"}
    found = fc.advise(scene, accuracy=1e-4, step=1e-3, fmu=fmu_path)
    words = [f"--set={name}={value}" for name, value in scene.items()]
    main(advise_command, [*words, "--accuracy=1e-4", "--step=1e-3", "--fmu", str(fmu_path)])
    assert capsys.readouterr().out.startswith(f"{found}\n")
    assert found.start_values == {**scene, **found.settings}
    assert set(found.settings) == {"solver.tolerance"} and found.error <= 1e-4 * 55.0


@pytest.mark.parametrize("again", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_every_result_is_copied_and_pickled(
    dry: fc.Identification, fmu_path: Path, again: Callable[[Any], Any]
) -> None:
    scene = {"V": 0.1, "vibration.V_1": 1.0}
    mass = fc.advise(scene, mass=1.0, step=1e-9, fmu=fmu_path)
    for result in (dry, fc.advise(scene, fmu=fmu_path), mass, fc.contacts):
        assert str(again(result)) == str(result) and repr(again(result)) == repr(result)
    assert again(dry).intervals == dry.intervals and len(again(dry).plot().axes) == 2
    law = fc.friction_law(scene, fmu=fmu_path)
    assert again(law)(0.3) == law(0.3)


def test_what_is_no_path_of_an_fmu_is_one_line() -> None:
    for fmu in (3, True, "a\0.fmu"):
        for call in (
            lambda fmu: fc.simulate(stop=1.0, step=1.0, fmu=fmu),
            lambda fmu: fc.simulate_many({"V": [0.1]}, fmu=fmu),
            lambda fmu: fc.sweep(output="nowhere", vary={"V": [0.1]}, fmu=fmu),
            lambda fmu: fc.FrictionFmu(fmu),
        ):
            with pytest.raises(fc.UserError, match=f"{re.escape(repr(str(fmu)))}: is no path$"):
                call(fmu)
