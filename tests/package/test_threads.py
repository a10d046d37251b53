"""Many threads open, step and close; the folders that this takes are gone at the end."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import pytest

import frictioncontact as fc

SCENE = {"V": 0.5, "vibration.V_1": 1.0}
ROWS = {"V": [0.1, 0.2, 0.3], "F_t_mean": [50.0, 51.0, 50.5]}
PROGRAM = "import sys; import frictioncontact as fc; fmu = fc.FrictionFmu(sys.argv[1]); print(fmu.directory)"


def test_threads_agree_and_the_working_directory_stays(fmu_path: Path) -> None:
    """64 sessions in 8 threads, twice, beside a thread that looks at the working directory all the time."""
    home, seen, done = Path.cwd(), set(), threading.Event()

    def watch() -> None:
        while not done.is_set():
            seen.add(Path.cwd())

    def use(k: int) -> tuple[float, ...]:
        with fc.FrictionFmu(fmu_path) as fmu, fmu.session(SCENE) as contact:
            contact.step(1e-4)
            mean = contact.get("F_t_mean")
        table = fc.simulate(SCENE, stop=1e-4, step=1e-4, outputs=["F_t_mean"], fmu=fmu_path)
        found = fc.identify(ROWS, "F_C", fmu=fmu_path) if k % 16 == 0 else None
        force = found.values["F_C"] if found else 50.5
        return mean, table["F_t_mean"].iloc[-1], fc.friction_law(SCENE, fmu=fmu_path)(0.5), round(force, 6)

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        with ThreadPoolExecutor(8) as pool:
            answers = {answer for _ in range(2) for answer in pool.map(use, range(64))}
    finally:
        done.set()
        watcher.join()
    ((mean, row, settled, _),) = answers
    assert mean == row and mean == pytest.approx(settled, rel=1e-3)
    assert seen == {home}


def test_nothing_is_left_of_an_fmu_that_nobody_closes(fmu_path: Path, tmp_path: Path) -> None:
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    command = [sys.executable, "-c", PROGRAM, str(fmu_path)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert Path(done.stdout.strip()).is_relative_to(tmp_path) and not list(tmp_path.iterdir())


@pytest.mark.skipif(not hasattr(os, "ST_NOEXEC"), reason="the system has no such flag")
def test_a_temporary_folder_without_the_right_to_execute(
    fmu_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a mount with noexec answers."""

    def load(path: str) -> None:
        raise OSError(f"{path}: failed to map segment from shared object")

    monkeypatch.setattr("frictioncontact.fmu.cdll", SimpleNamespace(LoadLibrary=load))
    with pytest.raises(fc.UserError, match=r"is not an FMU: its library: .* failed to map"):
        fc.FrictionFmu(fmu_path)
    monkeypatch.setattr(os, "statvfs", lambda path: SimpleNamespace(f_flag=os.ST_NOEXEC))
    with pytest.raises(fc.UserError, match=r"does not allow programs to run.* TMPDIR"):
        fc.FrictionFmu(fmu_path)
