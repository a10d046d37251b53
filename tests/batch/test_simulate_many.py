"""simulate_many against formulas, against sessions opened one by one, and with values that are wrong."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from frictioncontact.batch import BatchError, simulate_many
from frictioncontact.fmu import FrictionFmu
from frictioncontact.sweeps.workers import OUTPUTS

VIBRATING = {"vibration.V_1": 1.44}
F_C, V_1 = 55.0, 1.44  # N, m/s


def random_scenarios(count: int, seed: int) -> pd.DataFrame:
    random = np.random.default_rng(seed)
    return pd.DataFrame(
        {
            "V": random.uniform(-1.0, 2.0, count),
            "vibration.V_1": random.choice([0.0, 0.3, 1.44], count),
            "vibration.a_d": random.choice([0.0, 0.8e-6], count),
            "d": random.uniform(12e-6, 17e-6, count),
            "contact.stiffnessScale": 10.0 ** random.uniform(-7, 0, count),
            "friction.model": random.choice(["Dahl", "Coulomb"], count),
            "solver.method": random.choice(["collocation", "collocation", "cvode"], count),
            "delta_0": random.choice([0.0, 1e-7], count),
        }
    )


def sampled_period(fmu: FrictionFmu, values: dict, samples: int) -> dict[str, float]:
    """By itself, what a sweep has of a scenario but the reduction: a period in samples steps, after 40."""
    with fmu.session(values) as session:
        period = 1.0 / session.get("vibration.f")
        session.step(40.0 * period)
        work, rows = session.get("W_f"), []
        for _ in range(samples):
            session.step(period / samples)
            rows.append(session.read(["F_t", "sigma", "A_r"]))
        force, sigma, area = np.transpose(rows)
        return {
            "F_mean": session.get("F_t_settled"), "F_min": force.min(), "F_max": force.max(),
            "sigma_mean": sigma.mean(), "A_r_mean": area.mean(), "W_period": session.get("W_f") - work,
            "evaluations": session.get("solver.evaluations"),
        }  # fmt: skip


class TestNumbers:
    def test_mean_of_coulomb_friction(self, fmu_path: Path) -> None:
        """2 / pi F_C asin(V / V_1): no bristle, and a bristle that is stiff."""
        V = np.linspace(0.01, 1.4, 40)
        values = {"V": V[:, None], "friction.model": ["Coulomb", "Dahl"], **VIBRATING}
        got = simulate_many(values, threads=3, fmu=fmu_path)
        expected = 2.0 / np.pi * F_C * np.arcsin(V / V_1)
        assert got["F_t_mean"].shape == (40, 2)
        assert got["F_t_mean"][:, 0] == pytest.approx(expected, rel=1e-9)
        assert got["F_t_mean"][:, 1] == pytest.approx(expected, rel=2e-5)

    @pytest.mark.parametrize(("samples", "threads"), [(1, 2), (64, 1)])
    def test_bits_of_single_sessions(self, fmu: FrictionFmu, samples: int, threads: int) -> None:
        """One instance that is reset gives what a fresh one gives, in the same steps."""
        scenarios = random_scenarios(40, samples)
        outputs = {name: output for name, output in OUTPUTS.items() if name != "reduction"}
        got = simulate_many(scenarios, outputs, settle=40.0, samples=samples, threads=threads, fmu=fmu.path)
        for row, values in enumerate(scenarios.to_dict("records")):
            assert {name: got[name].iloc[row] for name in got} == sampled_period(fmu, values, samples), values

    def test_inputs_and_steps_are_those_of_single_sessions(self, fmu: FrictionFmu, fmu_path: Path) -> None:
        """To the bit, with a vibration that has begun before; a first step of no length reads the start."""
        random = np.random.default_rng(5)
        steps = np.concatenate([[0.0], random.uniform(1e-6, 1e-3, 12)])
        V, d = random.uniform(-0.5, 0.5, 13), random.uniform(13e-6, 15e-6, 13)
        rates = random.uniform(-500.0, 500.0, 13)
        scale = np.array([1e-7, 1e-5, 1e-3])
        got = simulate_many(
            {"contact.stiffnessScale": scale, "vibration.V_1": 0.3}, {"force": ("F_t", "samples")}, unit="s",
            inputs={"V": V, "d": d}, rates={"V": rates}, steps=steps, begin=1.3e-5, fmu=fmu_path)  # fmt: skip
        for row, value in zip(got["force"], scale, strict=True):
            with fmu.session({"contact.stiffnessScale": value, "vibration.V_1": 0.3}, 1.3e-5) as session:
                for k, h in enumerate(steps):
                    session.set("V", V[k])
                    session.set("d", d[k])
                    session.set_rates(V=rates[k])
                    session.step(h)
                    assert row[k] == session.get("F_t")

    def test_settle_and_duration_of_every_scenario(self, fmu_path: Path) -> None:
        """Work of steady sliding is F_C V t; a period is that of the scenario."""
        duration, f, work = np.array([1.0, 2.0, 5.0]), np.array([1e4, 2e4, 4e4]), {"work": ("W_f", "change")}
        settle = [1.0, 0.5, 2.0]
        got = simulate_many({"V": 0.3}, work, unit="s", settle=settle, duration=duration, fmu=fmu_path)
        assert got["work"] == pytest.approx(F_C * 0.3 * duration, rel=1e-9)
        got = simulate_many({"V": 0.3, "vibration.f": f}, work, settle=100.0, fmu=fmu_path)
        assert got["work"] == pytest.approx(F_C * 0.3 / f, rel=1e-9)

    def test_settled_start_is_where_settling_ends(self, fmu_path: Path) -> None:
        """And a period of it turns all work into heat: the bristle stores none, d does not move."""
        values = {"V": [[0.05], [0.4], [1.2]], "contact.stiffnessScale": [1e-7, 1e-6], **VIBRATING}
        values["solver.tolerance"] = 1e-9
        outputs = {"mean": "F_t_mean", "work": ("W_f", "change"), "heat": ("Q_f", "change")}
        settled = simulate_many(values, outputs, settled=True, fmu=fmu_path)
        waited = simulate_many(values, outputs, settle=1e6, fmu=fmu_path)
        assert settled["mean"] == pytest.approx(waited["mean"], abs=1e-7 * F_C)
        assert settled["heat"] == pytest.approx(settled["work"], rel=1e-6)


class TestShapes:
    def test_frame_in_frame_out(self, fmu_path: Path) -> None:
        frame = pd.DataFrame({"V": [0.1, 0.2], "friction.model": ["Dahl", "Coulomb"]}, index=["a", "b"])
        frame["friction.model"] = frame["friction.model"].astype("category")
        got = simulate_many(frame, {"F": ("F_t", "samples"), "W": "W_f"}, samples=2, fmu=fmu_path)
        assert list(got.index) == ["a", "b"]
        assert list(got.columns) == ["F[0]", "F[1]", "W"]

    def test_one_scenario_and_none(self, fmu_path: Path) -> None:
        assert simulate_many({}, fmu=fmu_path)["F_t_mean"].shape == ()
        got = simulate_many({"V": np.empty((0, 3))}, errors="keep", fmu=fmu_path)
        assert got["F_t_mean"].shape == got["reason"].shape == (0, 3)


class TestRefusals:
    def test_kept_with_the_message(self, fmu: FrictionFmu, fmu_path: Path) -> None:
        d = np.array([14e-6, -1e-6, 15e-6, 0.0])
        got = simulate_many({"d": d, **VIBRATING}, errors="keep", threads=2, fmu=fmu_path)
        alone = simulate_many({"d": d[::2], **VIBRATING}, fmu=fmu_path)
        assert list(got["reason"] == None) == [True, False, True, False]  # noqa: E711
        assert "d = -1e-06 m" in got["reason"][1]
        assert np.isnan(got["F_t_mean"][[1, 3]]).all()
        assert (got["F_t_mean"][::2] == alone["F_t_mean"]).all()

    def test_instance_is_usable_after_a_refused_step(self, fmu_path: Path) -> None:
        """solver.stepSize would need more steps than are allowed: refused in fmi2DoStep, not before."""
        values = {"V": 0.1, "solver.method": ["rk4", "collocation"], **VIBRATING}
        got = simulate_many(values, settle=1e8, errors="keep", threads=1, fmu=fmu_path)
        assert "solver.stepSize" in got["reason"][0]
        assert got["F_t_mean"][1] == pytest.approx(2 / np.pi * F_C * np.arcsin(0.1 / V_1), rel=2e-5)

    def test_first_one_is_raised(self, fmu_path: Path) -> None:
        d = np.full((50, 40), 14e-6)
        d[20:, 7:] = -3e-6
        with pytest.raises(BatchError, match=r"^scenario \(20, 7\): .*d = -3e-06 m"):
            simulate_many({"d": d}, threads=4, fmu=fmu_path)

    @pytest.mark.parametrize(
        ("values", "message"),
        [
            ({"V": [[0.1, 0.2], [0.1, np.inf]]}, r"column V, row \(1, 1\): inf is not a finite number"),
            ({"V": [0.1, 0.2], "d": [14e-6] * 3}, "column d: its 3 values do not go with the 2 of those"),
            ({"F_t": 0.1}, "column F_t: F_t is an output of the FMU and can't be set"),
            ({"friction.model": [1, 1.5]}, "column friction.model, row 1: 1.5 is not one of Dahl, "),
            (pd.DataFrame({"V": [0.1, pd.NA]}), "column V, row 1: '<NA>' is not a number"),
            (pd.DataFrame([[1, 2]], columns=["V", "V"]), "column V: is there twice"),
            ({"V": np.ma.array([[0.1, 0.2]], mask=[[0, 1]])}, r"column V, row \(0, 1\): is masked"),
            ({"V": [[0.1, 0.2], [0.3]]}, "column V: its rows are not of one length"),
            ([0.1, 0.2], "values: must be a mapping of names to values, or a pandas frame"),
            ({"V": np.ones((10**6, 1)), "d": np.full(10**6, 14e-6)}, "no memory for 1000000000000 scenarios"),
        ],
    )
    def test_wrong_values(self, fmu_path: Path, values: dict, message: str) -> None:
        with pytest.raises(BatchError, match=message) as caught:
            simulate_many(values, fmu=fmu_path)
        assert "\n" not in str(caught.value)

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            ({"outputs": "F_t"}, "outputs = 'F_t': must be a sequence"),
            ({"outputs": {"a": ("F_t", "median")}}, "output a: 'median' is not one of end, change, mean"),
            ({"samples": 10**11}, "samples = 100000000000: must be a whole number from 1 to"),
            (
                {"values": pd.DataFrame({"V": [0.1] * 2}), "settle": [[1.0], [2.0]]},
                "its 2 x 1 values do not go",
            ),
            ({"settle": [1.0, -2.0]}, "settle, row 1: -2 must be at least 0"),
            ({"unit": "ms"}, "unit = 'ms': must be 'period' or 's'"),
            ({"errors": "ignore"}, "errors = 'ignore'"),
            ({"threads": 1.5}, "threads = 1.5: must be a whole number from 1 to 1024"),
            ({"inputs": {"V": [0.1]}, "steps": [1.0, 1.0]}, "input V: 1 values for 2 steps"),
            ({"inputs": {"F_C": [0.1]}}, "input F_C: F_C is a parameter of the FMU, not one of V, d, E"),
            ({"rates": {"V": [0.1]}}, "rate of V: inputs has no values of V"),
            ({"values": {"initialState": 1}, "settled": True}, "initialState: settled gives it already"),
        ],
    )
    def test_wrong_arguments(self, fmu_path: Path, arguments: dict, message: str) -> None:
        with pytest.raises(BatchError, match=message):
            simulate_many(**{"values": {"V": [0.1, 0.2]}, "fmu": fmu_path, **arguments})


class TestFiles:
    def test_nothing_stays_in_the_file_system(self, fmu_path: Path, tmp_path: Path) -> None:
        code = f"from frictioncontact.batch import simulate_many; simulate_many({{}}, fmu={str(fmu_path)!r})"
        subprocess.run([sys.executable, "-c", code], env=environment(tmp_path), check=True)
        assert list(tmp_path.iterdir()) == []

    def test_not_an_fmu(self, repacked: Callable[..., Path], tmp_path: Path) -> None:
        """tests/commands/test_damaged_fmu.py damages one anywhere."""

        def no_library(entries: dict[str, bytes]) -> None:
            entries.update({name: b"no" for name in entries if name.endswith(".so")})

        def other_platform(entries: dict[str, bytes]) -> None:
            kept = {"modelDescription.xml": entries["modelDescription.xml"]}
            entries.clear()
            entries.update(kept | {"binaries/other64/FrictionContact.so": b""})

        def other_guid(entries: dict[str, bytes]) -> None:
            text = entries["modelDescription.xml"]
            entries["modelDescription.xml"] = re.sub(rb'guid="[^"]*"', b'guid="{0}"', text)

        for made, message in (
            (lambda: repacked(no_library), "is not an FMU: its library: "),
            (lambda: repacked(other_platform), "has no binary for this platform, .*, only other64"),
            (lambda: repacked(other_guid), r"the guid is \{0\}"),
            (lambda: repacked(dict.clear), "is not an FMU: its modelDescription.xml: "),
            (lambda: Path(__file__), "is not an FMU: File is not a zip file"),
            (lambda: tmp_path / "none.fmu", "No such file"),
        ):
            with pytest.raises(BatchError, match=f"^[^\n]*{message}[^\n]*$"):
                simulate_many({"V": [0.1, 0.2]}, errors="keep", fmu=made())


def environment(tmp: Path) -> dict[str, str]:
    paths = os.pathsep.join(path for path in sys.path if path)
    return {**os.environ, "PYTHONPATH": paths, "TMPDIR": str(tmp)}


# A million scenarios of short steps, and one scenario with a single step of seconds.
MANY = '{"V": __import__("numpy").linspace(0.1, 1, 10**6), "vibration.V_1": 1.44}, samples=64'
LONG = (
    '{"vibration.V_1": 1.44, "contact.stiffnessScale": 1e-6, "solver.method": "rk4"}, '
    'unit="s", duration=100.0, samples=100_000'
)


class TestStops:
    @pytest.mark.parametrize("scenarios", [MANY, LONG])
    def test_at_an_interrupt(self, fmu_path: Path, tmp_path: Path, scenarios: str) -> None:
        """Control-C reaches the caller, who is told of no thread, file or message that stays."""
        code = (
            "import sys, time\nfrom frictioncontact.batch import simulate_many\n"
            "def told(finished, refused):\n"
            "    print('running', flush=True)\n"
            f"try:\n    simulate_many({scenarios}, fmu={str(fmu_path)!r}, threads=2, progress=told)\n"
            "except KeyboardInterrupt:\n    print('interrupted')\n"
        )
        process = subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env=environment(tmp_path), start_new_session=True,
        )  # fmt: skip
        assert process.stdout.readline() == "running\n"
        os.killpg(process.pid, signal.SIGINT)
        printed, said = process.communicate(timeout=600)
        assert printed.endswith("interrupted\n")
        assert said == ""
        assert process.returncode == 0
        assert list(tmp_path.iterdir()) == []

    def test_with_what_progress_raises(self, fmu_path: Path) -> None:
        def told(finished: int, refused: int) -> None:
            raise RuntimeError("enough")

        before = threading.active_count()
        with pytest.raises(RuntimeError, match="enough"):
            simulate_many({"V": np.linspace(0.1, 1.0, 10**6), **VIBRATING}, progress=told, fmu=fmu_path)
        assert threading.active_count() == before

    def test_progress_tells_all(self, fmu_path: Path) -> None:
        seen: list[tuple[int, int]] = []
        d = np.where(np.arange(300) % 3, 14e-6, -1.0)
        simulate_many({"d": d}, errors="keep", progress=lambda *told: seen.append(told), fmu=fmu_path)
        assert seen[-1] == (300, 100) and seen == sorted(seen)
