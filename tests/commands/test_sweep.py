"""scripts/sweep: right numbers, nothing lost or done twice, one clear line for what can't be done."""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import quad

from frictioncontact.errors import UserError
from frictioncontact.sweeps import run as sweep_command
from frictioncontact.sweeps.run import Swept, sweep

Started = Callable[..., subprocess.Popen]
REFUSED = ["--vary", "d=-1e-6,14e-6", "--vary", "V=0.1,0.2"]  # the first two of four
GRID = ["--vary", "V=0.005:0.5:40:log", "--vary", "vibration.V_1=0:1.44:25"]  # 1000 scenarios
MANY = [
    "--random", "20000", "--seed", "3", "--vary", "V=0.01:1:log", "--vary", "d=-0.1e-6:15e-6",
    "--vary", "friction.model=Dahl,Coulomb", "--set", "vibration.V_1=1.44", "--samples", "1",
]  # fmt: skip


def command(fmu: Path, output: Path, *arguments: str) -> list[str]:
    """As the file of scripts/ runs it."""
    module = [sys.executable, "-m", "frictioncontact", "sweep"]
    return [*module, "--fmu", str(fmu), "--output", str(output), *arguments]


def swept(fmu: Path, output: Path, *words: str) -> Swept:
    """What the command does, in this process."""
    options = sweep_command.arguments(command(fmu, output, *words)[4:])
    return sweep(**sweep_command.wanted(options))


def wait_for(condition: Callable[[], object], seconds: float = 600.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


def parts(output: Path) -> list[Path]:
    return list((output / "parts").glob("*.parquet"))


def kept_rows(output: Path) -> int:
    """Scenarios whose group counts as run, good or refused."""
    return sum(
        len(pd.read_parquet(path))
        for part in parts(output)
        for path in (part, output / "failed.parquet" / part.name)
        if path.exists()
    )


@pytest.fixture
def started() -> Iterator[Started]:
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


def evaluate(fmu: Path, folder: Path, values: dict[str, float], samples: int) -> pd.Series:
    """A scenario as a sweep runs it."""
    vary = {name: [value] for name, value in values.items()}
    swept = sweep(fmu=fmu, output=folder / "one", vary=vary, samples=samples, workers=1, fresh=True)
    assert (swept.good, swept.refused) == (1, 0)
    return pd.read_parquet(swept.results).iloc[0]


def test_stiff_contact_gives_the_coulomb_limit(fmu_path: Path, tmp_path: Path) -> None:
    V = 0.5
    row = evaluate(fmu_path, tmp_path, {"V": V, "vibration.V_1": 1.44}, 64)
    mean, turn = 55.0 * 2 / np.pi * np.arcsin(V / 1.44), np.arccos(-V / 1.44) / 2 / np.pi
    path = quad(lambda t: abs(V + 1.44 * np.cos(2 * np.pi * t)), 0, 1, points=[turn])
    assert row["F_mean"] == pytest.approx(mean, rel=1e-5)
    assert row["reduction"] == pytest.approx(100 * (1 - mean / 55.0), rel=1e-5)
    assert (row["F_min"], row["F_max"]) == pytest.approx((-55.0, 55.0), rel=1e-6)
    assert row["sigma_mean"] == pytest.approx(5.743065402e12, rel=1e-9)
    assert row["A_r_mean"] == pytest.approx(5.187698908e-7, rel=1e-9)
    # Sliding dissipates F_C times the path, but for the two reversals.
    assert row["W_period"] == pytest.approx(55.0 * path[0] / 20e3, rel=1e-3)


def test_reduction_is_against_the_law_s_own_friction(fmu_path: Path, tmp_path: Path) -> None:
    """The limit is mu times the load, and viscous friction adds sigma_2 V to both."""
    values = {"V": -0.5, "vibration.V_1": 1.44, "load": 300.0, "friction.mu": 0.2, "friction.sigma_2": 8.0}
    values |= {"contact.input": "Load", "friction.limit": "Load", "friction.model": "Coulomb"}
    row = evaluate(fmu_path, tmp_path, values, 1)
    reduced = 60.0 * (1 - 2 / np.pi * np.arcsin(0.5 / 1.44))
    assert row["reduction"] == pytest.approx(100 * reduced / (60.0 + 8.0 * 0.5), rel=1e-9)
    assert np.isnan(evaluate(fmu_path, tmp_path, {"V": 0.0, "vibration.V_1": 1.44}, 1)["reduction"])


class TestRuns:
    def test_refused_scenarios_are_kept_apart(self, fmu_path: Path, tmp_path: Path) -> None:
        run, output = partial(swept, fmu_path, tmp_path / "sweep"), tmp_path / "sweep"
        done = run(*REFUSED)
        assert (done.good, done.refused, done.new) == (2, 2, 4) and "2 failed scenarios" in str(done)
        good, bad = pd.read_parquet(output / "results.parquet"), pd.read_parquet(output / "failed.parquet")
        assert (list(good["scenario"]), list(bad["scenario"])) == ([2, 3], [0, 1])
        assert all("d = -1e-06 m" in reason for reason in bad["reason"])
        assert str(run(*REFUSED)).endswith("4 scenarios were there from an earlier run")
        with pytest.raises(UserError, match="holds another sweep"):
            run("--vary", "V=0.1,0.3")
        (output / "sweep.json").unlink()  # what the results are of is not known
        with pytest.raises(UserError, match="holds another sweep"):
            run(*REFUSED)
        (output / "parts").mkdir()
        (output / "parts" / "mine.txt").write_text("mine")
        with pytest.raises(UserError, match=f"^{output}: can't be written: Directory not empty$"):
            run("--vary", "V=0.1,0.3", "--fresh")
        (output / "parts" / "mine.txt").unlink()
        assert run("--vary", "V=0.1,0.3", "--fresh").good == 2
        assert sorted(path.name for path in output.iterdir()) == ["results.parquet", "sweep.json"]
        assert list(pd.read_parquet(output / "results.parquet")["V"]) == [0.1, 0.3]

    def test_groups_and_workers_leave_the_numbers(self, fmu_path: Path, tmp_path: Path) -> None:
        """Each scenario has its own, whoever runs it with which others."""
        tables = []
        for group, workers in ((250, 1), (33, 2)):
            words = ("--samples", "2", "--group", str(group), "--workers", str(workers))
            done = swept(fmu_path, tmp_path / str(group), *GRID, *words)
            assert done.workers == workers and len(list(done.results.iterdir())) == -(-1000 // group)
            tables.append(pd.read_parquet(done.results))
        assert tables[0].equals(tables[1])

    def test_killed_at_any_moment(self, fmu_path: Path, tmp_path: Path, started: Started) -> None:
        """No row is lost or done twice."""
        output, arguments = tmp_path / "sweep", [*MANY, "--group", "500"]
        sweeping = started(command(fmu_path, output, *arguments))
        wait_for(lambda: parts(output))
        with contextlib.suppress(subprocess.TimeoutExpired):
            sweeping.wait(np.random.default_rng().uniform(0.0, 0.05))
        sweeping.kill()
        sweeping.wait()
        kept = kept_rows(output)
        assert swept(fmu_path, output, *arguments).new == 20_000 - kept
        assert {path.name for path in output.iterdir()} == {"failed.parquet", "results.parquet", "sweep.json"}
        good, bad = (pd.read_parquet(output / name) for name in ("results.parquet", "failed.parquet"))
        assert np.array_equal(np.union1d(good["scenario"], bad["scenario"]), np.arange(20_000))
        assert len(good) + len(bad) == 20_000 > kept > 0
        ignores_d = good["friction.model"] == "Coulomb"
        assert (bad["d"] < 0.0).all() and ((good["d"] > 0.0) | ignores_d).all() and len(bad) > 0

    def test_missing_part_is_run_again(self, fmu_path: Path, tmp_path: Path) -> None:
        """Cut short, in a whole sweep; and refused scenarios that are gone."""
        run = partial(swept, fmu_path, tmp_path, *REFUSED, "--samples", "1", "--group", "1")
        damaged = max(run().results.iterdir())
        damaged.write_bytes(damaged.read_bytes()[:-20])
        assert run().new == 1
        for part in (tmp_path / "failed.parquet").iterdir():
            part.unlink()
        assert run().new == 2
        assert list(pd.read_parquet(tmp_path / "failed.parquet")["scenario"]) == [0, 1]
        assert list(pd.read_parquet(tmp_path / "results.parquet")["scenario"]) == [2, 3]

    @pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
    def test_control_c(self, fmu_path: Path, tmp_path: Path, started: Started, by: signal.Signals) -> None:
        """One line, exit status 130, whole groups and nothing else; soon, in the midst of large groups."""
        output = tmp_path / "sweep"
        endless = ["--random", "10000000", "--vary", "V=0.01:1", "--group", "20000", "--samples", "1"]
        sweeping = started(command(fmu_path, output, *endless), stderr=subprocess.PIPE, text=True)
        wait_for(lambda: len(parts(output)) >= 2)
        sweeping.send_signal(by)
        _, said = sweeping.communicate(timeout=600)
        assert sweeping.returncode == 130 and len(said.splitlines()) == 1
        assert said.startswith("stopped; what was computed is kept; the same sweep"), said
        assert sorted(path.name for path in output.iterdir()) == ["parts", "sweep.json"]
        assert all(path.suffix == ".parquet" for path in (output / "parts").iterdir())

    def test_full_disk(self, fmu_path: Path, tmp_path: Path) -> None:
        """A limit of the size of files gives the error that a full disk gives, in the midst of a write."""
        arguments = ["--random", "50001", "--vary", "V=0.01:1", "--vary", "d=13e-6:15e-6", "--samples", "1"]
        arguments += ["--group", "50000", "--workers", "1"]

        def limited() -> None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (2_000_000, 2_000_000))

        sweeping = command(fmu_path, tmp_path / "sweep", *arguments)
        done = subprocess.run(sweeping, capture_output=True, text=True, timeout=600, preexec_fn=limited)
        assert done.returncode == 1
        assert done.stderr == f"error: {tmp_path / 'sweep'}: can't be written: File too large\n"
        # The group of one scenario may come before the one that fails; nothing else is left.
        left = {path.name for path in (tmp_path / "sweep").glob("*/*")}
        assert left <= {"0000050000-0000050000.parquet"}
