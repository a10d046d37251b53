"""scripts/sweep --cluster: the workers of a Dask cluster, which need this package and may get lost."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
import pytest
from deadly import deadly
from distributed import Client
from test_sweep import (
    GRID,
    Ran,
    Started,
    check_grid,
    command,
    environment,
    kept_rows,
    parts,
    ran,
    started,
    wait_for,
)

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.sweeps import workers
from frictioncontact.sweeps.workers import Job

__all__ = ["ran", "started"]
SWEEP = (*GRID, "--group", "10", "--samples", "16")


class Cluster:
    """A scheduler and workers of one thread each, as their user starts them."""

    def __init__(self, folder: Path) -> None:
        self._contact, self._workers = folder / "scheduler.json", []
        self._env = {
            **environment(), "PYTHONPATH": str(Path(__file__).parent),
            "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",  # of workers, by a task
        }  # fmt: skip
        self.scheduler = self._start("scheduler", "--port", "0")
        wait_for(lambda: self._contact.exists() and self._contact.read_text().endswith("}"))
        self.address = pd.read_json(self._contact, typ="series")["address"]

    def _start(self, what: str, *words: str, **variables: str) -> subprocess.Popen:
        dask = [Path(sys.executable).parent / "dask", what, "--scheduler-file", self._contact]
        words = ("--host", "127.0.0.1", "--no-dashboard", *words)
        return subprocess.Popen([*dask, *words], stderr=subprocess.DEVNULL, env=self._env | variables)

    def workers(self, count: int, **variables: str) -> list[subprocess.Popen]:
        """So many, without those before."""
        for worker in self._workers:
            worker.kill()
            worker.wait()
        self.wait_for_workers(0)
        words = ("worker", "--nthreads", "1", "--no-nanny")
        self._workers = [self._start(*words, **variables) for _ in range(count)]
        self.wait_for_workers(count)
        return self._workers

    def wait_for_workers(self, count: int) -> None:
        with Client(self.address, timeout=600) as client:
            wait_for(lambda: len(client.scheduler_info(n_workers=-1)["workers"]) == count)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    made = Cluster(tmp_path_factory.mktemp("cluster"))
    yield made
    for process in (*made._workers, made.scheduler):
        process.kill()
        process.wait()


def test_no_workers_or_one_of_another_version(cluster: Cluster, ran: Ran, tmp_path: Path) -> None:
    address, output = cluster.address, tmp_path / "sweep"
    done = ran(output, "--vary", "V=0.1,0.2", "--cluster", address)
    assert (done.returncode, done.stderr) == (1, f"error: cluster {address}: has no workers\n")
    other = tmp_path / "other" / "frictioncontact-0.0.1.dist-info"
    other.mkdir(parents=True)
    (other / "METADATA").write_text("Metadata-Version: 2.1\nName: frictioncontact\nVersion: 0.0.1\n")
    cluster.workers(1, PYTHONPATH=str(other.parent))
    done = ran(output, *GRID, "--cluster", address)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
    assert done.stderr.startswith(f"error: cluster {address}: tcp://127.0.0.1:")
    assert "lacks frictioncontact" in done.stderr and "pip install 'frictioncontact[sweep]==" in done.stderr
    assert not output.exists()


def test_no_scheduler(ran: Ran, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "CONNECT_SECONDS", 1.0)
    for address, message in {"tcp://127.0.0.1:1": "nothing answers there", "rubbish": "missing port"}.items():
        done = ran(tmp_path / "sweep", "--vary", "V=0.1,0.2", "--cluster", address)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1
        assert done.stderr.startswith(f"error: cluster {address}: {message}")
    assert list(tmp_path.iterdir()) == []


def test_scenario_that_kills_its_workers(cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    cluster.workers(2)
    monkeypatch.setattr(workers, "run_group", deadly)
    message = f"^cluster {cluster.address}: worker after worker died of a group; what was computed is kept"
    staffed = workers.cluster(Job(b"", None, {}, 1), cluster.address)
    with pytest.raises(UserError, match=message), staffed as staff:
        list(staff.run([(k, k + 1) for k in range(9)]))


def test_a_worker_and_then_the_scheduler_are_lost(
    cluster: Cluster, fmu: FrictionFmu, tmp_path: Path, started: Started
) -> None:
    """The last of the tests, which share it: the sweep goes on, or ends in a line and keeps what it has."""
    one, two = cluster.workers(2)
    whole, cut = (command(fmu.path, tmp_path / name, *SWEEP, "--cluster", cluster.address) for name in "ab")
    sweeping = started(whole, stdout=subprocess.PIPE, text=True)
    wait_for(lambda: len(parts(tmp_path / "a")) >= 6)
    one.kill()
    assert kept_rows(tmp_path / "a") < 900
    printed, _ = sweeping.communicate(timeout=600)
    assert sweeping.returncode == 0 and two.poll() is None
    assert "1000 scenarios in" in printed and "on 2 workers" in printed
    check_grid(tmp_path / "a", fmu)
    sweeping = started(cut, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: len(parts(tmp_path / "b")) >= 3)
    cluster.scheduler.kill()
    _, said = sweeping.communicate(timeout=600)
    assert sweeping.returncode == 1 and len(said.strip().splitlines()) == 1, said
    assert said.startswith(f"error: cluster {cluster.address}: the connection was lost; what was computed is")
    assert kept_rows(tmp_path / "b") >= 30
