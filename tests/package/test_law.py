"""fc.friction_law, fc.variables, warnings and sessions: what a user of Python meets first."""

from __future__ import annotations

import ast
import importlib
import pickle
import re
import textwrap
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import frictioncontact as fc
from frictioncontact import law as command
from frictioncontact import simulation
from frictioncontact.__main__ import COMMANDS
from frictioncontact.command import main
from frictioncontact.fmu import FrictionFmu, Session
from frictioncontact.parameters import STIFFNESS_PRINTED
from tools.project import ROOT

COULOMB = {"friction.model": "Coulomb", "vibration.V_1": 1.44}
SOFT = {"vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}


class TestLaw:
    def test_the_amplitude_for_a_reduction(self, fmu_path: Path) -> None:
        """Coulomb's mean is (2/pi) F_C asin(V / V_1); the law is as before afterwards."""
        law = fc.friction_law(COULOMB, fmu=fmu_path)
        before = law(0.1)
        for reduction in (0.1, 0.6, 0.99):
            right = 0.1 / np.sin(0.5 * np.pi * (1.0 - reduction))
            assert law.amplitude_for(reduction, 0.1) == pytest.approx(right, rel=1e-6)
        assert law(0.1) == before
        with pytest.raises(fc.UserError, match=r"up to .* m/s lowers the force by 0\.99999"):
            law.amplitude_for(0.99999, 0.1)
        with pytest.raises(fc.UserError, match="reduction = 60: must be between 0 and 1"):
            law.amplitude_for(60, 0.1)

    def test_coulomb_s_law_and_its_derivative(self, fmu_path: Path) -> None:
        """(2 / pi) F_C asin(V / V_1), in the shape of the velocities."""
        V = np.array([[0.1, 0.5], [1.0, -0.3]])
        law = fc.friction_law(COULOMB, fmu=fmu_path)
        np.testing.assert_allclose(law(V), 110 / np.pi * np.arcsin(V / 1.44), rtol=1e-9)
        np.testing.assert_allclose(law.derivative(V), 110 / np.pi / np.sqrt(1.44**2 - V**2), rtol=1e-6)
        assert isinstance(law(0.5), float) and isinstance(law.derivative(0.5), float)

    def test_inputs_broadcast_and_are_forgotten(self, fmu_path: Path) -> None:
        law = fc.friction_law({**COULOMB, "contact.input": "Load", "friction.limit": "Load"}, fmu=fmu_path)
        before = law(0.5)
        found = law([0.1, 0.5, 1.0], load=[[100.0], [300.0]])
        assert found.shape == (2, 3)
        np.testing.assert_allclose(found[1], 3.0 * found[0], rtol=1e-9)
        assert law.derivative(0.5, "load", load=100.0) == pytest.approx(found[0, 1] / 100.0, rel=1e-6)
        assert law(0.5) == before  # with the scene's load again

    def test_coulomb_s_law_in_the_plane(self, fmu_path: Path) -> None:
        """At rest in y under a circular vibration both forces turn with the velocity (V, V_y)."""
        around = {"vibration.V_2": 1.44, "vibration.phase_2": np.pi / 2}
        law = fc.friction_law(COULOMB | around, fmu=fmu_path)
        speed, angle = 0.5, np.array([0.0, 0.4, 2.0])
        V, V_y = speed * np.cos(angle), speed * np.sin(angle)
        force = law(speed)
        np.testing.assert_allclose(law(V, V_y=V_y), force * np.cos(angle), rtol=1e-9, atol=1e-8)
        np.testing.assert_allclose(law.transverse(V, V_y=V_y), force * np.sin(angle), rtol=1e-9, atol=1e-8)
        assert law.derivative(speed, "V_y", of="F_y_settled") == pytest.approx(force / speed, rel=1e-6)
        assert law.derivative(speed, "V_y") == pytest.approx(0.0, abs=1e-4)

    def test_the_derivative_at_a_jump_is_none(self, fmu_path: Path) -> None:
        """Coulomb's at rest, and what sticks in a small vibration; a force that is continuous has one."""
        stuck = SOFT | {"friction.model": "ElasticPlastic", "vibration.V_1": 0.1}
        for scene in ({"friction.model": "Coulomb"}, {}, stuck):
            law = fc.friction_law(scene, fmu=fmu_path)
            assert np.isnan(law.derivative([0.0, 0.1])).tolist() == [True, False]
            assert law.derivative(0.0, "d") == pytest.approx(0.0, abs=1e-3)
        law = fc.friction_law(COULOMB, fmu=fmu_path)
        assert law.derivative(0.0) == pytest.approx(110 / np.pi / 1.44, rel=1e-6)
        assert law.derivative(1.44) == 0.0  # a kink

    def test_it_draws(self, fmu_path: Path) -> None:
        assert len(fc.friction_law(SOFT, fmu=fmu_path).plot().axes) == 2

    def test_what_is_wrong_is_one_line(self, fmu_path: Path) -> None:
        law = fc.friction_law(SOFT, fmu=fmu_path)
        for call, message in (
            (lambda: law([1.0, 2.0], E=[1e9, 2e9, 3e9]), "the shapes do not go together: V (2,), E (3,)"),
            (lambda: law(0.5, d=-1e-6), "fmi2GetReal: the outputs can't be computed: d = -1e-06 m must be"),
            (lambda: law.derivative(0.5, "F_C"), "by: F_C is a parameter of the FMU, not one of V, d, E"),
            (lambda: law.derivative(0.5, of="F_t"), "of F_t: must be F_t_settled or F_y_settled"),
        ):
            with pytest.raises(fc.UserError, match="^" + re.escape(message)):
                call()


def warned(call: Callable[[], object]) -> list[str]:
    """What a call warns of, at this file's lines."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    for one in caught:
        assert one.category is fc.FrictionWarning and one.filename == __file__
    return [str(one.message) for one in caught]


def run(scene: dict, **options: object) -> Callable[[], object]:
    return lambda: fc.simulate(scene, stop=1e-5, step=1e-5, **options)


class TestWarnings:
    def test_of_a_scene_that_was_hardly_meant_and_of_no_other(self) -> None:
        for scene, says in (
            ({"load": 10.0}, "load has no effect: contact.input = Separation; it is used with Load"),
            ({"friction.staticRatio": 1.5}, "friction.staticRatio has no effect: friction.model = Dahl"),
            ({"vibration.phase_d": 1.0}, "vibration.phase_d has no effect: vibration.a_d = 0"),
            ({"V_y": -500.0}, "V_y = -500 m/s is an unlikely magnitude: -500 mm/s is -0.5 here"),
            ({"E": 58.0}, "E = 58 Pa is an unlikely magnitude: 58 GPa is 5.8e+10 here"),
        ):
            (text,) = warned(run(scene))
            assert text.startswith(says)
        many = {"friction.model": ["Dahl", "LuGre"], "friction.staticRatio": 2}
        assert warned(run({"vibration.a_d": 0.0, "vibration.phase_d": 3.9})) == []  # switched off on purpose
        assert warned(lambda: fc.simulate_many(many)) == []
        for contact in fc.contacts.values():
            assert warned(lambda contact=contact: fc.friction_law(contact.start)) == []

    def test_of_the_fmu_s_log(self) -> None:
        """A step of a period: F_t and F_y are samples. Who reads neither needs no warning."""
        for outputs in (["F_t", "W_f"], ["F_y"]):
            (text,) = warned(lambda outputs=outputs: fc.simulate(SOFT, stop=1e-4, step=5e-5, outputs=outputs))
            assert "exceeds half a period" in text
        assert warned(lambda: fc.simulate(SOFT, stop=1e-4, step=5e-5, outputs=["F_t_mean"])) == []

    def test_of_a_settled_start_of_a_contact_that_is_nearly_open(self) -> None:
        """The bristle is F_C / sigma, and by Eq. 3 and 20 sigma falls as e^(-2 lambda d / R_q) / d^3."""
        lifted = {"initialState": "Settled", "V": 0.1, "d": 50e-6}
        (text,) = warned(run(lifted, outputs=["F_t_mean"]))
        delta, sigma = map(float, re.findall(r"bristle by (\S+) m: .*sigma = (\S+) N/m.*F_C = 55 N", text)[0])
        assert sigma == pytest.approx(STIFFNESS_PRINTED * np.exp(-36.0) * (14 / 50) ** 3, rel=1e-9)
        assert delta == pytest.approx(55.0 / sigma, rel=1e-9)
        for other in ({"d": 25e-6}, {"d": 1e-3}, {"initialState": "Given"}, {"friction.limit": "Load"}):
            assert warned(run({**lifted, **other}, outputs=["F_t_mean"])) == []

    def test_from_every_call(self, tmp_path: Path) -> None:
        scene = {"contact.sigma": 1e6}
        data = fc.contacts["steel-dry"].data
        for call in (
            lambda: fc.simulate_many({"V": [0.1], **scene}),
            lambda: fc.friction_law(scene),
            lambda: fc.advise(scene),
            lambda: fc.identify(data, "contact.stiffnessScale", start=scene),
            lambda: fc.sweep(output=tmp_path, vary={"V": "0.1,0.2"}, set=scene),
        ):
            assert [text.split(":")[0] for text in warned(call)] == ["contact.sigma has no effect"]

    def test_commands_say_them_and_a_name_that_is_too_long(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        words = ["--stop", "1e-5", "--step", "1e-5"]
        main(simulation, [*words, "--set", "load=10"])
        printed, said = capsys.readouterr()
        assert printed.startswith(" time [s]  F_t [N]")
        assert said.startswith("warning: load has no effect: ") and said.count("\n") == 1
        target = tmp_path / ("x" * 250)  # too long with what an unfinished file is called
        with pytest.raises(SystemExit, match=f"^error: {re.escape(str(target))}: [^\n]*$") as ended:
            main(simulation, [*words, "--output", str(target)])
        assert ".part" not in str(ended.value)


def test_tables_for_people_have_units_and_no_rounding(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of 4e-15 N, a sum of 55 N and -55 N, nothing is shown; a CSV file has the number."""
    scene = ["--set", "friction.model=Coulomb", "--set", "vibration.V_1=1", "--vary", "V=0"]
    main(command, scene)
    heads, row = capsys.readouterr().out.splitlines()
    assert heads.split("  ") == [" V [m/s]", "F_t_settled [N]", "d/dV [N s/m]"]
    assert row.split()[:2] == ["0", "0"] and float(row.split()[2]) == pytest.approx(110 / np.pi, rel=1e-5)
    main(command, [*scene, "--output", str(tmp_path / "law.csv")])
    heads, row = (tmp_path / "law.csv").read_text().splitlines()
    assert heads == "V,F_t_settled,d/dV" and 0.0 < abs(float(row.split(",")[1])) < 1e-12


class TestSessions:
    def test_a_saved_state_goes_on_as_the_first_time(self, fmu: FrictionFmu) -> None:
        """Here and in another session, whose parameters and inputs it brings along."""

        def go_on(session: Session) -> list[float]:
            session.set("V", -0.3)
            session.step(2e-5)
            return [session.time, *session.read()]

        with fmu.session({"V": 0.5, "friction.model": "ElasticPlastic", **SOFT}) as session:
            session.step(3e-5)
            state = pickle.loads(pickle.dumps(session.save()))
            expected = go_on(session)
            session.step(1e-5)
            session.restore(state)
            assert session.time == 3e-5 and session.get("V") == 0.5 and go_on(session) == expected
        with fmu.session() as other:
            other.restore(state)
            assert go_on(other) == expected

    def test_what_is_wrong_is_one_line(self, fmu: FrictionFmu) -> None:
        with fmu.session() as it:
            for call, message in (
                (lambda: it.set("v", 1.0), "set v: v is no variable of the FMU; did you mean V?"),
                (lambda: it.set("F_t", 1.0), "fmi2SetReal: F_t is an output variable and can't"),
                (lambda: it.set("friction.model", "Dal"), "set friction.model: 'Dal' is not one of Dahl"),
                (lambda: it.get("Ft"), "get: Ft is no variable of the FMU; did you mean F_t?"),
                (lambda: it.step(-1.0), "fmi2DoStep: "),
                (lambda: it.step("1e-3"), "h = '1e-3' is not a number"),
                (lambda: it.restore(b"state"), "restore: \"b'state'\" is not a state that save() gave"),
            ):
                with pytest.raises(fc.UserError, match="^" + re.escape(message)):
                    call()
            assert it.time == 0.0 and it.get("V") == 0.005  # as before
        assert issubclass(fc.UserError, ValueError)


def test_variables_are_a_table() -> None:
    table = fc.variables()
    assert table.loc["F_C", ["unit", "start", "min"]].to_list() == ["N", 55.0, 1e-12]
    assert table.loc["friction.model", "items"]["LuGre"] == 4 and len(table.loc["V", "meaning"]) > 20
    assert table.loc["friction.model", "start"] == "Dahl"


def test_a_file_is_written_into_a_folder_that_is_there(capsys: pytest.CaptureFixture[str]) -> None:
    for name, option in (("simulate", "--output"), ("law", "--picture"), ("playground", "--output")):
        module = importlib.import_module(f"frictioncontact.{COMMANDS[name][0]}")
        words = ["--stop", "1", "--step", "1"] if name == "simulate" else []
        with pytest.raises(SystemExit, match=r"^2$"):
            module.arguments([*words, option, "nowhere/file.png"])
        assert f"argument {option}: there is no folder nowhere" in capsys.readouterr().err


def test_the_examples_of_the_docstrings_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The indented code at the end of each docstring of the package, and of the package itself."""
    monkeypatch.chdir(tmp_path)
    warnings.simplefilter("error", fc.FrictionWarning)
    run = set()
    for path in sorted((ROOT / "frictioncontact").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)):
                code = re.search(r"\n\n((?:    .*\n?|\n)+)", ast.get_docstring(node) or "")
                if code and "fc." in code[1]:
                    run.add(getattr(node, "name", path.stem))
                    exec(compile(textwrap.dedent(code[1]), path, "exec"), {"fc": fc, "pd": pd})
    assert {"friction_law", "simulate", "simulate_many", "identify", "advise", "sweep", "variables"} <= run
