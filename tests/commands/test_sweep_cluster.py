"""scripts/sweep --cluster: the workers of a Dask cluster, which need this package and may get lost."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd
import pytest
from deadly import deadly
from distributed import Client
from test_sweep import GRID, Ran, check_grid, command, environment, kept_rows, parts, ran, started, wait_for

from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu
from frictioncontact.sweeps import workers
from frictioncontact.sweeps.group import Job

__all__ = ["ran", "started"]
DASK = Path(sys.executable).parent / "dask"
Started = Callable[..., subprocess.Popen]


def with_another_version(folder: Path) -> dict[str, str]:
    """The environment of a machine that has frictioncontact 0.0.1."""
    (folder / "frictioncontact-0.0.1.dist-info").mkdir(parents=True)
    metadata = "Metadata-Version: 2.1\nName: frictioncontact\nVersion: 0.0.1\n"
    (folder / "frictioncontact-0.0.1.dist-info" / "METADATA").write_text(metadata)
    return {**environment(), "PYTHONPATH": str(folder)}


class Cluster:
    """A scheduler and workers of one thread each, as their user starts them."""

    def __init__(self, started: Started, folder: Path) -> None:
        self._started, self._contact = started, folder / "scheduler.json"
        self._options = {"cwd": folder, "stderr": subprocess.DEVNULL}
        self._env = {
            **environment(), "PYTHONPATH": str(Path(__file__).parent),
            "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",  # of workers, by a task
        }  # fmt: skip
        self.scheduler = started(
            [DASK, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
             "--scheduler-file", self._contact], **self._options, env=self._env,
        )  # fmt: skip
        wait_for(lambda: self._contact.exists() and self._contact.read_text().endswith("}"))
        self.address = pd.read_json(self._contact, typ="series")["address"]

    def worker(self, env: dict[str, str] | None = None, nanny: str = "--no-nanny") -> subprocess.Popen:
        return self._started(
            [DASK, "worker", "--scheduler-file", self._contact, "--host", "127.0.0.1", "--nthreads", "1",
             nanny, "--no-dashboard"], **self._options, env=env or self._env,
        )  # fmt: skip

    def wait_for_workers(self, count: int) -> None:
        with Client(self.address, timeout=600) as client:
            client.wait_for_workers(count, timeout=600)


@pytest.fixture
def cluster(started: Started, tmp_path: Path) -> Iterator[Cluster]:
    (tmp_path / "cluster").mkdir()
    return Cluster(started, tmp_path / "cluster")


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
    assert done.stderr == f"error: --cluster {cluster.address}: has no workers\n"
    cluster.worker(with_another_version(tmp_path / "other"))
    cluster.wait_for_workers(1)
    done = ran(tmp_path / "sweep", *GRID, "--cluster", cluster.address)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1, done.stderr
    assert done.stderr.startswith(f"error: --cluster {cluster.address}: tcp://127.0.0.1:")
    assert "lacks frictioncontact" in done.stderr
    assert "pip install 'frictioncontact[sweep]==" in done.stderr
    assert not (tmp_path / "sweep").exists()


@pytest.mark.parametrize(
    ("address", "message"),
    [("tcp://127.0.0.1:1", "nothing answers there"), ("rubbish", "missing port number")],
)
def test_no_scheduler(
    ran: Ran, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, address: str, message: str
) -> None:
    monkeypatch.setattr(workers, "CONNECT_SECONDS", 1.0)
    done = ran(tmp_path / "sweep", "--vary", "V=0.1,0.2", "--cluster", address)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1, done.stderr
    assert done.stderr.startswith(f"error: --cluster {address}: {message}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_scheduler_that_goes_away(cluster: Cluster, fmu_path: Path, tmp_path: Path, started: Started) -> None:
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
    lost = f"error: --cluster {cluster.address}: the connection was lost; what was computed is kept; the same"
    assert said.startswith(lost), said
    assert kept_rows(output) >= 30


def test_scenario_that_kills_its_workers(cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    cluster.worker(nanny="--nanny")
    cluster.wait_for_workers(1)
    monkeypatch.setattr(workers, "run_group", deadly)
    job = Job(b"", None, {}, 1)
    message = f"^--cluster {cluster.address}: worker after worker died of a group; what was computed is kept"
    with pytest.raises(UserError, match=message), workers.cluster(job, cluster.address) as staff:
        list(staff.run([(k, k + 1) for k in range(9)]))
