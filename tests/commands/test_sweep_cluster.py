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
from frictioncontact.sweeps.group import Job

__all__ = ["ran", "started"]
DASK = Path(sys.executable).parent / "dask"


def with_another_version(folder: Path) -> dict[str, str]:
    """The environment of a machine that has frictioncontact 0.0.1."""
    (folder / "frictioncontact-0.0.1.dist-info").mkdir(parents=True)
    metadata = "Metadata-Version: 2.1\nName: frictioncontact\nVersion: 0.0.1\n"
    (folder / "frictioncontact-0.0.1.dist-info" / "METADATA").write_text(metadata)
    return {**environment(), "PYTHONPATH": str(folder)}


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

    def _start(self, what: str, *words: str, env: dict[str, str] | None = None) -> subprocess.Popen:
        command = [DASK, what, "--scheduler-file", self._contact, "--host", "127.0.0.1", "--no-dashboard"]
        return subprocess.Popen(
            [*command, *words], cwd=self._contact.parent, stderr=subprocess.DEVNULL, env=env or self._env
        )

    def worker(self, env: dict[str, str] | None = None) -> subprocess.Popen:
        self._workers.append(self._start("worker", "--nthreads", "1", "--no-nanny", env=env))
        return self._workers[-1]

    def wait_for_workers(self, count: int) -> None:
        with Client(self.address, timeout=600) as client:
            wait_for(lambda: len(client.scheduler_info(n_workers=-1)["workers"]) == count)

    def end(self) -> None:
        """Of the workers, which the scheduler is then without."""
        for worker in self._workers:
            worker.kill()
            worker.wait()
        self._workers.clear()
        if self.scheduler.poll() is None:
            self.wait_for_workers(0)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    yield cluster
    cluster.scheduler.kill()
    cluster.scheduler.wait()


@pytest.fixture
def cluster(whole: Cluster) -> Iterator[Cluster]:
    """Without workers; its scheduler is that of all tests."""
    yield whole
    whole.end()


def test_cluster_that_loses_a_worker(
    cluster: Cluster, fmu_path: Path, fmu: FrictionFmu, tmp_path: Path, started: Started
) -> None:
    one, two = cluster.worker(), cluster.worker()
    cluster.wait_for_workers(2)
    output = tmp_path / "sweep"
    arguments = (*GRID, "--group", "10", "--cluster", cluster.address, "--samples", "16")
    sweeping = started(command(fmu_path, output, *arguments), stdout=subprocess.PIPE, text=True)
    wait_for(lambda: len(parts(output)) >= 6)
    one.kill()
    assert kept_rows(output) < 900
    printed, _ = sweeping.communicate(timeout=600)
    assert sweeping.returncode == 0
    assert "1000 scenarios in" in printed and "on 2 workers" in printed
    assert two.poll() is None
    check_grid(output, fmu)


def test_no_workers_or_one_of_another_version(cluster: Cluster, ran: Ran, tmp_path: Path) -> None:
    done = ran(tmp_path / "sweep", "--vary", "V=0.1,0.2", "--cluster", cluster.address)
    assert done.returncode == 1
    assert done.stderr == f"error: cluster {cluster.address}: has no workers\n"
    cluster.worker(with_another_version(tmp_path / "other"))
    cluster.wait_for_workers(1)
    done = ran(tmp_path / "sweep", *GRID, "--cluster", cluster.address)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1, done.stderr
    assert done.stderr.startswith(f"error: cluster {cluster.address}: tcp://127.0.0.1:")
    assert "lacks frictioncontact" in done.stderr
    assert "pip install 'frictioncontact[sweep]==" in done.stderr
    assert not (tmp_path / "sweep").exists()


def test_no_scheduler(ran: Ran, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "CONNECT_SECONDS", 1.0)
    for address, message in (
        ("tcp://127.0.0.1:1", "nothing answers there"),
        ("rubbish", "missing port number"),
    ):
        done = ran(tmp_path / "sweep", "--vary", "V=0.1,0.2", "--cluster", address)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1
        assert done.stderr.startswith(f"error: cluster {address}: {message}")
    assert list(tmp_path.iterdir()) == []


def test_scenario_that_kills_its_workers(cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    for _ in range(2):
        cluster.worker()
    cluster.wait_for_workers(2)
    monkeypatch.setattr(workers, "run_group", deadly)
    job = Job(b"", None, {}, 1)
    message = f"^cluster {cluster.address}: worker after worker died of a group; what was computed is kept"
    with pytest.raises(UserError, match=message), workers.cluster(job, cluster.address) as staff:
        list(staff.run([(k, k + 1) for k in range(9)]))


@pytest.mark.slow
def test_scheduler_that_goes_away(cluster: Cluster, fmu_path: Path, tmp_path: Path, started: Started) -> None:
    """The last of the tests, which share it."""
    cluster.worker()
    cluster.wait_for_workers(1)
    output = tmp_path / "sweep"
    arguments = (*GRID, "--group", "10", "--samples", "16")
    sweeping = started(
        command(fmu_path, output, *arguments, "--cluster", cluster.address), stderr=subprocess.PIPE, text=True
    )
    wait_for(lambda: len(parts(output)) >= 3)
    cluster.scheduler.kill()
    _, said = sweeping.communicate(timeout=600)
    assert sweeping.returncode == 1
    assert len(said.strip().splitlines()) == 1, said
    lost = f"error: cluster {cluster.address}: the connection was lost; what was computed is kept; the same"
    assert said.startswith(lost), said
    assert kept_rows(output) >= 30
