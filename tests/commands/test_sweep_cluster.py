"""scripts/sweep --cluster: the workers of a Dask cluster, which need this package and may get lost."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import pandas as pd
import pytest
from test_sweep import kept_rows, parts, wait_for

from frictioncontact.errors import UserError
from frictioncontact.sweeps import workers
from frictioncontact.sweeps.run import sweep
from frictioncontact.sweeps.workers import Group, Job

SMALL = {"vary": {"V": "0.1,0.2"}}
WHOLE = {"vary": {"V": "0.005:0.5:40:log", "vibration.V_1": "0:1.44:25"}, "group": 10, "samples": 16}


class Cluster:
    """A scheduler and workers of one thread each, as their user starts them."""

    def __init__(self, folder: Path) -> None:
        from distributed import Client

        contact = folder / "scheduler.json"
        self.start = partial(self._start, contact)
        self.processes: list[subprocess.Popen] = []
        self.scheduler = self.start("scheduler", "--port", "0")
        wait_for(lambda: contact.exists() and contact.read_text().endswith("}"))
        self.address = pd.read_json(contact, typ="series")["address"]
        self.client = Client(self.address, timeout=600)

    def _start(self, contact: Path, what: str, *words: str) -> subprocess.Popen:
        dask = [Path(sys.executable).parent / "dask", what, "--scheduler-file", contact]
        words = ("--host", "127.0.0.1", "--no-dashboard", *words)
        fails = {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}  # workers, by a task
        process = subprocess.Popen([*dask, *words], stderr=subprocess.DEVNULL, env=os.environ | fails)
        self.processes.append(process)
        return process

    def workers(self, count: int) -> list[subprocess.Popen]:
        started = [self.start("worker", "--nthreads", "1", "--no-nanny") for _ in range(count)]
        wait_for(lambda: len(self.client.scheduler_info(n_workers=-1)["workers"]) == count)
        return started


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    made = Cluster(tmp_path_factory.mktemp("cluster"))
    yield made
    made.client.close()
    for process in made.processes:
        process.kill()
        process.wait()


def test_no_scheduler(fmu_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "CONNECT_SECONDS", 1.0)
    for address, message in {"tcp://127.0.0.1:1": "nothing answers there", "rubbish": "missing port"}.items():
        with pytest.raises(UserError, match=f"^cluster {address}: {message}[^\n]*$"):
            sweep(**SMALL, output=tmp_path / "sweep", cluster=address, fmu=fmu_path)
    assert list(tmp_path.iterdir()) == []


def test_no_workers_or_ones_of_another_version(
    cluster: Cluster, fmu_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    swept = partial(sweep, **SMALL, output=tmp_path / "sweep", cluster=cluster.address, fmu=fmu_path)
    with pytest.raises(UserError, match=f"^cluster {cluster.address}: has no workers$"):
        swept()
    cluster.workers(2)
    monkeypatch.setattr(workers, "version", lambda name: "9.9.9")
    lacks = f"cluster {cluster.address}: scheduler lacks frictioncontact 9.9.9 with its sweeps: pip install"
    with pytest.raises(UserError, match=rf"^{lacks} 'frictioncontact\[sweep\]==9.9.9' there$"):
        swept()
    assert not (tmp_path / "sweep").exists()


def test_a_worker_is_lost_and_then_one_that_a_scenario_kills(
    cluster: Cluster, fmu_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The sweep goes on without the first; a scenario that no worker survives ends it."""
    one, two = cluster.processes[-2:]
    with ThreadPoolExecutor(1) as pool:
        sweeping = pool.submit(sweep, **WHOLE, output=tmp_path, cluster=cluster.address, fmu=fmu_path)
        wait_for(lambda: len(parts(tmp_path)) >= 6 or sweeping.done())
        one.kill()
        assert kept_rows(tmp_path) < 900
        swept = sweeping.result(timeout=600)
    assert (swept.new, swept.workers, two.poll()) == (1000, 2, None)
    alone = sweep(**WHOLE, output=tmp_path / "alone", workers=1, fmu=fmu_path)
    pd.testing.assert_frame_equal(*map(pd.read_parquet, (swept.results, alone.results)), check_exact=True)

    def deadly(job: Job, group: Group) -> None:
        if group[0] <= 3 < group[1]:
            os._exit(1)

    monkeypatch.setattr(workers, "run_group", deadly)
    cluster.client.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0))
    message = f"^cluster {cluster.address}: worker after worker died of a group; what was computed is kept"
    staffed = workers.cluster(Job(b"", None, {}, 1), cluster.address)
    with pytest.raises(UserError, match=message), staffed as staff:
        list(staff.run([(k, k + 1) for k in range(9)]))
    two.wait(timeout=600)


def test_the_scheduler_is_lost(cluster: Cluster, fmu_path: Path, tmp_path: Path) -> None:
    """The last of the tests, which share it."""
    cluster.workers(1)
    lost = re.escape(f"cluster {cluster.address}: the connection was lost; what was computed is kept")
    with ThreadPoolExecutor(1) as pool:
        sweeping = pool.submit(sweep, **WHOLE, output=tmp_path, cluster=cluster.address, fmu=fmu_path)
        wait_for(lambda: len(parts(tmp_path)) >= 3 or sweeping.done())
        cluster.scheduler.kill()
        with pytest.raises(UserError, match=f"^{lost}[^\n]*$"):
            sweeping.result(timeout=600)
    assert kept_rows(tmp_path) >= 30
