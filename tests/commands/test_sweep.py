"""scripts/sweep: right numbers, nothing lost or done twice, one clear line for what can't be done."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import fmpy
import numpy as np
import pandas as pd
import psutil
import pytest
from batch.one_by_one import sampled_period
from deadly import deadly
from distributed import Client
from scipy.integrate import quad

from frictionlab.batch.many import built_runner
from frictionlab.fmu import FrictionFmu
from frictionlab.parameters import IDENTIFIED, TABLE_2, start_values
from frictionlab.project import UserError
from frictionlab.reference.solution import periodic_mean
from frictionlab.reference.start_values import scene_of
from frictionlab.sweep import cluster as sweep_cluster
from frictionlab.sweep import command as sweep
from frictionlab.sweep.plan import Scenarios
from frictionlab.sweep.scenario import RESULTS, Work, run_chunk
from frictionlab.sweep.spans import Chunks, missing
from frictionlab.sweep.stop import held_back

ROOT = Path(__file__).resolve().parents[2]
GRID = ["--vary", "V=0.005:0.5:40:log", "--vary", "vibration.V_1=0:1.44:25"]  # 1000 scenarios


def command(fmu: Path, output: Path, *arguments: str) -> list[str]:
    return [
        sys.executable,
        "-m",
        "frictionlab.sweep.command",
        "--fmu",
        str(fmu),
        "--output",
        str(output),
        *arguments,
    ]


def environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def without_project(folder: Path) -> dict[str, str]:
    """An environment in which `import frictionlab` fails, as on a machine that lacks this project."""
    (folder / "hidden").mkdir()
    (folder / "hidden" / "frictionlab.py").write_text("raise ImportError('this project is not here')\n")
    return {**environment(), "PYTHONPATH": str(folder / "hidden")}


def run(fmu: Path, output: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command(fmu, output, *arguments), capture_output=True, text=True, timeout=120, env=environment()
    )


def wait_for(condition: Callable[[], object], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


def kept_rows(output: Path) -> int:
    return sum(len(pd.read_parquet(part)) for part in (output / "parts").glob("*.parquet"))


def check_grid(output: Path, fmu: FrictionFmu) -> None:
    """All 1000 rows once and in order, with the numbers that the FMU gives in this process."""
    table = pd.read_parquet(output / "results.parquet")
    assert list(table["scenario"]) == list(range(1000))
    assert not table.isna().any().any()
    V, V_1 = np.geomspace(0.005, 0.5, 40), np.linspace(0, 1.44, 25)
    assert np.array_equal(table["V"], np.repeat(V, 25))
    assert np.array_equal(table["vibration.V_1"], np.tile(V_1, 40))
    for k in (0, 24, 500, 999):
        row = table.iloc[k]
        here = sampled_period(fmu, {name: row[name] for name in ("V", "vibration.V_1")}, 1e6, 16)
        assert set(here) == set(RESULTS) - {"seconds"}
        for name in here:
            assert row[name] == here[name], name


def processes_of_group(group: int) -> list[int]:
    """Processes that have not ended, whether or not their parent has looked after them."""
    found = []
    for process in psutil.process_iter(["pid", "status"]):
        with contextlib.suppress(ProcessLookupError):
            if os.getpgid(process.pid) == group and process.info["status"] != psutil.STATUS_ZOMBIE:
                found.append(process.pid)
    return found


def evaluate(fmu_path: Path, values: dict[str, float], samples: int) -> dict[str, float]:
    """A scenario as a worker runs it."""
    work = Work(fmu_path.read_bytes(), built_runner().read_bytes(), fmpy.platform, 1e6, samples)
    results = run_chunk(work, {name: np.array([value]) for name, value in values.items()})
    assert not results.reasons
    return {name: column[0] for name, column in results.columns.items()}


def table_of(scenarios: Scenarios) -> pd.DataFrame:
    return pd.DataFrame(scenarios.shown(0, scenarios.count))


@pytest.fixture
def started() -> Iterator[Callable[..., subprocess.Popen]]:
    """Starts processes in groups of their own, and ends what is left of them."""
    processes: list[subprocess.Popen] = []

    def start(arguments: list[str], **options: object) -> subprocess.Popen:
        processes.append(subprocess.Popen(arguments, start_new_session=True, **options))
        return processes[-1]

    yield start
    for process in processes:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.fixture
def endless(fmu_path: Path, started: Callable[..., subprocess.Popen]) -> Callable[..., subprocess.Popen]:
    """Starts a sweep of a million scenarios into a folder, with more variables of the environment."""

    def start(output: Path, more: Mapping[str, str] | None = None) -> subprocess.Popen:
        return started(
            command(fmu_path, output, "--random", "1000000", "--vary", "V=0.01:1", "--workers", "2"),
            env={**environment(), **(more or {})}, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip

    return start


TO_ALL = pytest.mark.parametrize("to_all", [True, False], ids=["group", "alone"])


def ended(sweeping: subprocess.Popen, by: signal.Signals, to_all: bool) -> str:
    """What a sweep said that was ended by a signal, to all its processes or to the first alone."""
    (os.killpg if to_all else os.kill)(sweeping.pid, by)
    _, said = sweeping.communicate(timeout=60)
    wait_for(lambda: not processes_of_group(sweeping.pid))
    return said


class TestScenario:
    """One scenario against formulas."""

    @pytest.mark.parametrize("V", [0.1, 0.5])
    def test_stiff_contact_gives_the_coulomb_limit(self, fmu_path: Path, V: float) -> None:
        row = evaluate(fmu_path, {"V": V, "vibration.V_1": 1.44}, 64)
        mean = 55.0 * 2 / np.pi * np.arcsin(V / 1.44)
        path = quad(
            lambda t: abs(V + 1.44 * np.cos(2 * np.pi * t)), 0, 1, points=[np.arccos(-V / 1.44) / 2 / np.pi]
        )
        assert row["F_mean"] == pytest.approx(mean, rel=1e-5)
        assert row["reduction"] == pytest.approx(100 * (1 - mean / 55.0), rel=1e-5)
        assert (row["F_min"], row["F_max"]) == pytest.approx((-55.0, 55.0), rel=1e-6)
        assert row["sigma_mean"] == pytest.approx(5.743065402e12, rel=1e-9)
        assert row["A_r_mean"] == pytest.approx(5.187698908e-7, rel=1e-9)
        # Sliding dissipates F_C times the path, but for the two reversals.
        assert row["W_period"] == pytest.approx(55.0 * path[0] / 20e3, rel=1e-3)

    def test_moving_separation(self, fmu_path: Path) -> None:
        """Row 2 of Table 2, identified; the mean stiffness is 1.5068 times that at rest."""
        start = start_values(TABLE_2[1], IDENTIFIED)
        row = evaluate(fmu_path, start, 64)
        assert row["F_mean"] == pytest.approx(21.56, abs=0.01)
        at_rest = evaluate(fmu_path, {**start, "vibration.a_d": 0.0}, 4)["sigma_mean"]
        assert row["sigma_mean"] / at_rest == pytest.approx(1.506797919, rel=1e-8)
        assert row["F_min"] < row["F_mean"] < row["F_max"]

    @pytest.mark.parametrize(
        "values",
        [
            {"V": 0.3, "vibration.V_1": 0.9, "vibration.a_d": 0.8e-6, "contact.stiffnessScale": 1e-6},
            {"V": -0.02, "vibration.V_1": 1.1, "vibration.phase_d": 2.0, "vibration.a_d": 0.4e-6},
            # V > 0 throughout, yet the mean is 1.2 F_C: V and the stiffness vary together.
            {"V": 0.013, "vibration.V_1": 0.0091, "d": 16.7e-6, "vibration.a_d": 0.5e-6,
             "contact.stiffnessScale": 1e-3},
        ],
    )  # fmt: skip
    def test_mean_of_the_reference(self, fmu_path: Path, values: dict[str, float]) -> None:
        mean = float(periodic_mean(scene_of(values)))
        assert evaluate(fmu_path, values, 8)["F_mean"] == pytest.approx(mean, abs=55e-6)

    def test_number_of_samples_leaves_the_mean(self, fmu_path: Path) -> None:
        start = start_values(TABLE_2[1], IDENTIFIED)
        means = [evaluate(fmu_path, start, samples)["F_mean"] for samples in (1, 7, 64)]
        assert means == pytest.approx([means[0]] * 3, abs=55e-6)


class TestPlan:
    def scenarios(self, fmu_path: Path, *arguments: str) -> pd.DataFrame:
        return table_of(sweep.scenarios_of(sweep.arguments(list(arguments)), fmu_path))

    def test_grid(self, fmu_path: Path) -> None:
        table = self.scenarios(
            fmu_path, "--vary", "V=1:100:3:log", "--vary", "friction.model=Dahl,Coulomb", "--set", "d=15e-6"
        )
        assert table.to_dict("list") == {
            "V": pytest.approx([1, 1, 10, 10, 100, 100]),
            "friction.model": ["Dahl", "Coulomb"] * 3,
            "d": [15e-6] * 6,
        }

    def test_random_is_repeatable_and_within_bounds(self, fmu_path: Path) -> None:
        arguments = "--random", "500", "--vary", "V=1e-3:1:log", "--vary", "d=10e-6:18e-6"
        table = self.scenarios(fmu_path, *arguments, "--seed", "1")
        pd.testing.assert_frame_equal(table, self.scenarios(fmu_path, *arguments, "--seed", "1"))
        assert not table.equals(self.scenarios(fmu_path, *arguments, "--seed", "2"))
        assert table["V"].between(1e-3, 1).all()
        assert table["d"].between(10e-6, 18e-6).all()
        assert 0.4 < (table["V"] < 10**-1.5).mean() < 0.6  # evenly over the decades

    def test_csv(self, fmu_path: Path, tmp_path: Path) -> None:
        path = tmp_path / "scenarios.csv"
        path.write_text("V, solver.method\n0.1, cvode\n\n0.2,rk4\n")
        table = self.scenarios(fmu_path, "--csv", str(path))
        assert table.to_dict("list") == {"V": [0.1, 0.2], "solver.method": ["cvode", "rk4"]}

    @pytest.mark.parametrize(
        ("content", "message"),
        [
            ("V,d\n0.1,14e-6\n0.2,abc\n", "row 3, column d: 'abc' is not a number"),
            ("V,d\n0.1,\n", "row 2, column d: '' is not a number"),
            ("V\nnan\n", "row 2, column V: 'nan' is not a finite number"),
            ("V,d\n0.1\n", "row 2: has 1 cells where the header has 2"),
            ("V,V\n1,2\n", "row 1, column 2: V is there twice"),
            ("V,vibration.V1\n1,2\n", "row 1, column 2: vibration.V1 is no variable of the FMU; did you"),
            ("solver.method\neuler\n", "row 2, column solver.method: 'euler' is not one of collocation"),
            ("V,F_t\n1,2\n", "row 1, column 2: F_t is an output of the FMU and can't be set"),
            (f"V\n{'1' * 131073}\n", "is not a CSV file in UTF-8: field larger than field limit (131072)"),
            (f"V\n{'x' * 131070}\n", f"row 2, column V: '{'x' * 40}...' is not a number"),
            ("V\n", "has no row below the header"),
            ("", "is empty; row 1 must name the variables"),
            ('V\n"0.1\n', "is not a CSV file"),
        ],
    )  # fmt: skip
    def test_malformed_csv_names_row_and_column(
        self, fmu_path: Path, tmp_path: Path, content: str, message: str
    ) -> None:
        path = tmp_path / "scenarios.csv"
        path.write_text(content)
        with pytest.raises(UserError, match=re.escape(f"{path}: {message}")):
            self.scenarios(fmu_path, "--csv", str(path))

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            ([], "nothing to sweep"),
            (["--vary", "v=1"], "--vary v: v is no variable of the FMU; did you mean V?"),
            (["--vary", "V"], "--vary V: is not of the form NAME=VALUE"),
            (["--vary", "V=1:2"], "'1:2' is neither low:high:count"),
            (["--vary", "V=2:1:3"], "--vary V: the range ends at 1, before it begins at 2"),
            (["--vary", "V=0:1:3:log"], "must begin above 0"),
            (["--vary", "V=0:1:²"], "the count '²' is not a whole number"),
            (["--vary", f"V=0:1:{'9' * 5000}"], "is not a whole number"),
            (
                ["--vary", "V=1", "--samples", "100000000000"],
                "must be at most 1000000",
            ),
            (["--vary", "V=1", "--settle", "inf"], "--settle inf: must be at most"),
            (
                ["--vary", "V=0:1", "--random", "99999999999"],
                "must be at most 10000000",
            ),
            (["--vary", "V=0:1:-3"], "the count '-3' is not a whole number"),
            (["--vary", "V=1", "--vary", "V=2"], "--vary V: is given twice"),
            (["--vary", "V=1", "--set", "V=2"], "--set V: is given twice"),
            (["--vary", "V=0:1:100000", "--vary", "d=1:2:1000"], "the most that a sweep runs is 10000000"),
            (["--vary", "V=1", "--workers", "0"], "--workers 0: must be at least 1"),
            (["--vary", "V=1", "--settle", "nan"], "--settle nan: must be at least 0"),
            (["--random", "3", "--vary", "V=0:1:3"], "'0:1:3' is neither low:high"),
            (["--csv", "none.csv", "--vary", "V=1"], "--csv does not go with --vary"),
        ],
    )
    def test_wrong_arguments(self, fmu_path: Path, arguments: list[str], message: str) -> None:
        with pytest.raises(UserError, match=re.escape(message)):
            self.scenarios(fmu_path, *arguments)


class TestSpans:
    def test_missing(self) -> None:
        assert missing(10, [(4, 6), (0, 2), (6, 7)]) == [(2, 4), (7, 10)]
        assert missing(10, []) == [(0, 10)]
        assert missing(3, [(0, 3)]) == []

    def test_chunks_cover_the_spans_once_in_order(self) -> None:
        chunks = Chunks([(2, 700), (900, 5000)], None, 2)
        numbers: list[int] = []
        for first, stop in chunks:
            assert first < stop
            numbers += range(first, stop)
            chunks.learn(stop - first, 1e-3 * (stop - first))
        assert numbers == [*range(2, 700), *range(900, 5000)]

    def test_size_follows_what_a_scenario_takes(self) -> None:
        chunks = Chunks([(0, 10**6)], None, 2)
        pieces = iter(chunks)
        for seconds, size in ((1e-4, 10_000), (1e-3, 1000), (100.0, 1)):  # a second's work
            for _ in range(10):
                first, stop = next(pieces)
                chunks.learn(stop - first, seconds * (stop - first))
            assert stop - first == size
        fixed = iter(Chunks([(0, 95)], 30, 2))
        assert [stop - first for first, stop in fixed] == [30, 30, 30, 5]

    def test_size_falls_towards_the_end(self) -> None:
        """Else one worker would still run a whole chunk when the others have nothing left."""
        chunks, sizes = Chunks([(0, 100_000)], None, 2), []
        for first, stop in chunks:
            sizes.append(stop - first)
            chunks.learn(stop - first, 1e-4 * (stop - first))
        assert max(sizes) == 10_000
        assert max(sizes[-3:]) <= 10_000 / 8
        assert [stop - first for first, stop in Chunks([(0, 10)], None, 2)] == [3, 2, 2, 1, 1, 1]


class TestStop:
    """Asked for at any place, it is raised at those where nothing is cut in two."""

    def test_is_raised_at_the_end_at_the_latest(self) -> None:
        before, passed = signal.getsignal(signal.SIGINT), []

        def held() -> None:
            with held_back():
                signal.raise_signal(signal.SIGINT)
                passed.append("signal")

        with pytest.raises(KeyboardInterrupt):
            held()
        assert passed == ["signal"]
        assert signal.getsignal(signal.SIGINT) is before

    def test_ends_a_wait_and_lets_events_through_before(self) -> None:
        events = []

        def held() -> None:
            with held_back() as stop:
                stop.add("event")
                events.append(stop.wait())
                threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGTERM)).start()
                events.append(stop.wait())

        with pytest.raises(KeyboardInterrupt):
            held()
        assert events == ["event"]


class TestRuns:
    def test_refused_scenarios_are_kept_apart(self, fmu_path: Path, tmp_path: Path) -> None:
        output = tmp_path / "sweep"
        done = run(fmu_path, output, "--vary", "d=-1e-6,14e-6", "--vary", "V=0.1,0.2", "--workers", "1")
        assert done.returncode == 0, done.stderr
        assert "2 failed scenarios" in done.stdout
        good, bad = pd.read_parquet(output / "results.parquet"), pd.read_parquet(output / "failed.parquet")
        assert list(good["scenario"]) == [2, 3]
        assert list(bad["scenario"]) == [0, 1]
        assert all("d = -1e-06 m" in reason for reason in bad["reason"])
        assert len(pd.read_csv(output / "failed.csv")) == 2
        again = run(fmu_path, output, "--vary", "d=-1e-6,14e-6", "--vary", "V=0.1,0.2")
        assert again.returncode == 0
        assert "nothing to do" in again.stdout
        other = run(fmu_path, output, "--vary", "V=0.1,0.3")
        assert other.returncode != 0
        assert other.stderr.startswith("error: ") and "holds another sweep" in other.stderr

    def test_goes_on_after_a_kill(
        self, fmu_path: Path, fmu: FrictionFmu, tmp_path: Path, started: Callable[..., subprocess.Popen]
    ) -> None:
        output = tmp_path / "sweep"
        arguments = (*GRID, "--chunk", "10", "--workers", "2", "--samples", "16")
        first = started(command(fmu_path, output, *arguments), env=environment())
        wait_for(lambda: len(list(output.glob("parts/*.parquet"))) >= 3)
        os.killpg(first.pid, signal.SIGKILL)
        first.wait()
        kept = kept_rows(output)
        assert 30 <= kept < 1000
        assert not (output / "results.parquet").exists()
        second = run(fmu_path, output, *arguments)
        assert second.returncode == 0, second.stderr
        assert f"{kept} scenarios were there from an earlier run" in second.stdout
        assert f"\n{1000 - kept} scenarios in" in second.stdout
        check_grid(output, fmu)
        assert sorted(path.name for path in output.iterdir()) == ["results.parquet", "sweep.json"]

    def test_hundred_thousand_scenarios_and_a_kill(
        self, fmu_path: Path, fmu: FrictionFmu, tmp_path: Path, started: Callable[..., subprocess.Popen]
    ) -> None:
        """Chunks of a size of their own before and after; no row is lost, done twice or out of order."""
        count, output = 100_000, tmp_path / "sweep"
        arguments = [
            "--random", str(count), "--seed", "3", "--vary", "V=0.01:1:log", "--vary", "d=13e-6:15e-6",
            "--vary", "friction.model=Dahl,Coulomb", "--set", "vibration.V_1=1.44",
            "--samples", "1", "--workers", "2",
        ]  # fmt: skip
        first = started(command(fmu_path, output, *arguments), env=environment())
        wait_for(lambda: len(list(output.glob("parts/*.parquet"))) >= 12)
        os.killpg(first.pid, signal.SIGKILL)
        first.wait()
        kept = kept_rows(output)
        assert 0 < kept < count
        damaged = max(output.glob("parts/*.parquet"))  # as a failing disk leaves it
        lost = len(pd.read_parquet(damaged))
        damaged.write_bytes(damaged.read_bytes()[:-20])
        second = run(fmu_path, output, *arguments)
        assert second.returncode == 0, second.stderr
        assert f"{kept - lost} scenarios were there from an earlier run" in second.stdout
        table = pd.read_parquet(output / "results.parquet")
        assert np.array_equal(table["scenario"], np.arange(count))
        scenarios = table_of(sweep.scenarios_of(sweep.arguments(arguments), fmu_path))
        assert table[list(scenarios)].equals(scenarios)
        for row in (0, 1234, 99_999):
            values = {name: table[name][row] for name in scenarios}
            assert table["F_mean"][row] == sampled_period(fmu, values, 1e6, 1)["F_mean"]
        coulomb = table[table["friction.model"] == "Coulomb"]
        expected = 55.0 * 2 / np.pi * np.arcsin(coulomb["V"] / 1.44)
        assert np.allclose(coulomb["F_mean"], expected, rtol=1e-9, atol=0.0)

    @TO_ALL
    @pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
    def test_nothing_is_left_but_the_rows(
        self, tmp_path: Path, endless: Callable[..., subprocess.Popen], by: signal.Signals, to_all: bool
    ) -> None:
        """Control-C on a terminal reaches the workers too. What is killed leaves only its folder."""
        output, temporary = tmp_path / "sweep", tmp_path / "temporary"
        temporary.mkdir()
        sweeping = endless(output, {"TMPDIR": str(temporary)})
        wait_for(lambda: len(list(output.glob("parts/*.parquet"))) >= 4)
        said = ended(sweeping, by, to_all)
        assert list(temporary.iterdir()) == []
        left = sorted(path.name for path in output.iterdir())
        if by == signal.SIGKILL:
            assert said == ""
            assert left == ["lock", "parts", "sweep.json", "work"]
        else:
            assert len(said.splitlines()) == 1 and said.startswith("stopped; what was computed is kept"), said
            assert left == ["parts", "sweep.json"]
            assert all(path.suffix == ".parquet" for path in (output / "parts").iterdir())

    @TO_ALL
    @pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
    def test_nothing_is_left_of_a_start(
        self, tmp_path: Path, endless: Callable[..., subprocess.Popen], by: signal.Signals, to_all: bool
    ) -> None:
        output = tmp_path / "sweep"
        sweeping = endless(output)
        wait_for((output / "work").exists)
        said = ended(sweeping, by, to_all)
        assert len(said.splitlines()) == 1 and said.startswith("stopped; "), said
        assert not output.exists()

    def test_dask_cluster_that_loses_a_worker(
        self, fmu_path: Path, fmu: FrictionFmu, tmp_path: Path, started: Callable[..., subprocess.Popen]
    ) -> None:
        """Workers know nothing of this project: its code and the FMU come with the work."""
        dask, contact = Path(sys.executable).parent / "dask", tmp_path / "scheduler.json"
        quiet = {"env": without_project(tmp_path), "cwd": tmp_path, "stderr": subprocess.DEVNULL}
        started([dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                 "--scheduler-file", contact], **quiet)  # fmt: skip
        wait_for(contact.exists)
        workers = [
            started([dask, "worker", "--scheduler-file", contact, "--host", "127.0.0.1", "--nthreads", "1",
                     "--no-nanny", "--no-dashboard", "--name", name], **quiet)
            for name in ("one", "two")
        ]  # fmt: skip
        address = pd.read_json(contact, typ="series")["address"]
        with Client(address, timeout=10) as client:
            client.wait_for_workers(2, timeout=60)
        output = tmp_path / "sweep"
        arguments = (*GRID, "--chunk", "10", "--scheduler", address, "--samples", "16")
        sweeping = started(
            command(fmu_path, output, *arguments), env=environment(), stdout=subprocess.PIPE, text=True
        )
        wait_for(lambda: len(list(output.glob("parts/*.parquet"))) >= 6)
        workers[0].kill()
        assert kept_rows(output) < 900
        printed, _ = sweeping.communicate(timeout=120)
        assert sweeping.returncode == 0
        assert "1000 scenarios in" in printed and "on 2 workers" in printed
        assert workers[1].poll() is None
        check_grid(output, fmu)

    @pytest.mark.slow
    def test_scheduler_that_goes_away(
        self, fmu_path: Path, tmp_path: Path, started: Callable[..., subprocess.Popen]
    ) -> None:
        contact = tmp_path / "scheduler.json"
        quiet = {"env": without_project(tmp_path), "cwd": tmp_path, "stderr": subprocess.DEVNULL}
        dask = Path(sys.executable).parent / "dask"
        scheduler = started([dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                             "--scheduler-file", contact], **quiet)  # fmt: skip
        wait_for(contact.exists)
        started([dask, "worker", "--scheduler-file", contact, "--nthreads", "1", "--no-nanny",
                 "--no-dashboard"], **quiet)  # fmt: skip
        address = pd.read_json(contact, typ="series")["address"]
        with Client(address, timeout=10) as client:
            client.wait_for_workers(1, timeout=60)
        output = tmp_path / "sweep"
        arguments = (*GRID, "--chunk", "10", "--scheduler", address, "--samples", "16")
        sweeping = started(
            command(fmu_path, output, *arguments), env=environment(), stderr=subprocess.PIPE, text=True
        )
        wait_for(lambda: len(list(output.glob("parts/*.parquet"))) >= 3)
        scheduler.kill()
        _, said = sweeping.communicate(timeout=120)
        assert sweeping.returncode == 1
        assert len(said.strip().splitlines()) == 1, said
        assert said.startswith(
            "error: the connection to the scheduler was lost; what was computed is kept in"
        )
        kept = kept_rows(output)
        assert kept >= 30
        rest = run(fmu_path, output, *GRID, "--samples", "16", "--workers", "2")
        assert f"{kept} scenarios were there from an earlier run" in rest.stdout, rest.stderr

    def test_scenario_that_kills_its_worker(self, tmp_path: Path) -> None:
        """It alone is given up."""

        kept: dict[int, str | None] = {}
        with sweep_cluster.connected(None, 1, tmp_path) as client:
            for (first, stop), results in sweep_cluster.run(
                client, deadly, b"", lambda span: {"number": np.arange(*span)}, Chunks([(0, 9)], 4, 1)
            ):
                for row in range(stop - first):
                    assert first + row not in kept
                    kept[first + row] = results.reasons.get(row)
        assert sorted(kept) == list(range(9))
        assert kept.pop(3) == "every process that ran this scenario died"
        assert not any(kept.values())


class TestNothingHalfWritten:
    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["--scheduler", "tcp://127.0.0.1:1"], "--scheduler tcp://127.0.0.1:1: nothing answers there"),
            (["--scheduler", "rubbish"], "--scheduler rubbish: missing port number"),
            (["--set", "vibration.v_1=1"], "did you mean vibration.V_1?"),
        ],
    )
    def test_one_line_and_no_files(
        self, fmu_path: Path, tmp_path: Path, arguments: list[str], message: str
    ) -> None:
        done = run(fmu_path, tmp_path / "sweep", "--vary", "V=0.1,0.2", *arguments)
        assert done.returncode == 1
        assert done.stdout == ""
        assert len(done.stderr.strip().splitlines()) == 1, done.stderr
        assert done.stderr.startswith("error: ") and message in done.stderr
        assert list(tmp_path.iterdir()) == []

    def test_not_an_fmu(self, tmp_path: Path) -> None:
        (tmp_path / "text.fmu").write_text("no zip")
        done = run(tmp_path / "text.fmu", tmp_path / "sweep", "--vary", "V=0.1,0.2")
        assert done.returncode == 1
        assert done.stderr == f"error: --fmu {tmp_path / 'text.fmu'}: is no FMU: File is not a zip file\n"
        assert not (tmp_path / "sweep").exists()

    @pytest.mark.parametrize("record", ['{"digest": "abc', "[]", "{}", "\xff"])
    def test_damaged_record(self, fmu_path: Path, tmp_path: Path, record: str) -> None:
        (tmp_path / "sweep.json").write_text(record, encoding="latin-1")
        done = run(fmu_path, tmp_path, "--vary", "V=0.1,0.2")
        assert done.returncode == 1
        assert len(done.stderr.splitlines()) == 1
        assert done.stderr.startswith(f"error: {tmp_path / 'sweep.json'}: is damaged; choose another")
        assert (tmp_path / "sweep.json").read_text(encoding="latin-1") == record

    def test_no_loopback(self, fmu_path: Path, tmp_path: Path) -> None:
        """In a network of its own whose loopback is down, as in some containers."""
        alone = ["unshare", "--net", "--map-root-user"]
        if subprocess.run([*alone, "true"], capture_output=True).returncode:
            pytest.skip("no network namespaces here")
        done = subprocess.run(
            [*alone, *command(fmu_path, tmp_path / "sweep", "--vary", "V=0.1", "--workers", "1")],
            capture_output=True, text=True, timeout=120, env={**environment(), "TMPDIR": str(tmp_path)},
        )  # fmt: skip
        assert done.returncode == 1
        assert len(done.stderr.splitlines()) == 1, done.stderr
        assert done.stderr.startswith("error: worker processes here can't be reached through the loopback")
        assert list(tmp_path.iterdir()) == []

    def test_unwritable_output(self, fmu_path: Path, tmp_path: Path) -> None:
        (tmp_path / "file").write_text("in the way")
        done = run(fmu_path, tmp_path / "file" / "sweep", "--vary", "V=0.1,0.2")
        assert done.returncode == 1
        assert (
            done.stderr.strip()
            == f"error: {tmp_path / 'file' / 'sweep'}: can't be written to: Not a directory"
        )
        assert (tmp_path / "file").read_text() == "in the way"
