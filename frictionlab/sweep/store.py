"""The folder of a sweep: rows are kept as they come, so that a killed sweep goes on where it was.

    sweep.json        what is being swept
    parts/*.parquet   rows that have been computed; gone when the sweep is whole
    results.parquet   at the end: one row a scenario
    failed.parquet    at the end, if any failed: scenarios with their reason (failed.csv: the same to read)

Every file is written under another name and renamed when whole.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import pandas as pd

from frictionlab.sweep.plan import PlanError, Value
from frictionlab.sweep.scenario import Sampling


def digest(scenarios: pd.DataFrame, fmu: bytes, sampling: Sampling) -> str:
    """Equal for equal sweeps: same scenarios in the same order, same FMU, same sampling."""
    state = hashlib.sha256(fmu)
    state.update(repr(sampling).encode())
    state.update(scenarios.to_csv(index=False).encode())
    return state.hexdigest()


class Store:
    """The folder, locked against other sweeps while it is open."""

    def __init__(self, folder: Path, plan: Mapping[str, Value], fresh: bool) -> None:
        """plan is what sweep.json holds; of another sweep's folder its "digest" differs, which is refused."""
        self.folder = folder
        self.plan = dict(plan)
        self._made = not folder.exists()
        try:
            (folder / "parts").mkdir(parents=True, exist_ok=True)
            self._lock = (folder / "lock").open("w")
        except OSError as error:
            raise PlanError(f"{folder}: can't be written to: {error.strerror}") from None
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._lock.close()
            raise PlanError(f"{folder}: another sweep is writing there") from None
        try:
            self._take_up(fresh)
        except PlanError:
            self.close()
            raise

    def _take_up(self, fresh: bool) -> None:
        record = self.folder / "sweep.json"
        if fresh:
            self._remove("results.parquet", "failed.parquet", "failed.csv", "sweep.json")
            for part in self._parts():
                part.unlink()
        for unfinished in (*self.folder.glob("*.unfinished"), *self.folder.glob("parts/*.unfinished")):
            unfinished.unlink()
        if record.exists():
            begun = json.loads(record.read_text())
            if begun["digest"] != self.plan["digest"]:
                raise PlanError(
                    f"{self.folder}: holds another sweep (other scenarios, sampling or FMU); "
                    "choose another --output, or --fresh to discard it"
                )
            return
        self._write("sweep.json", lambda path: path.write_text(json.dumps(self.plan, indent=2) + "\n"))

    def _parts(self) -> list[Path]:
        return sorted((self.folder / "parts").glob("*.parquet"))

    def _remove(self, *names: str) -> None:
        for name in names:
            (self.folder / name).unlink(missing_ok=True)

    def _write(self, name: str, write: object) -> None:
        unfinished = self.folder / f"{name}.unfinished"
        try:
            write(unfinished)  # type: ignore[operator]
            unfinished.replace(self.folder / name)
        except OSError as error:
            with contextlib.suppress(OSError):
                unfinished.unlink()
            raise PlanError(f"{self.folder / name}: can't be written: {error.strerror or error}") from None

    def is_whole(self) -> bool:
        return (self.folder / "results.parquet").exists()

    def done(self) -> set[int]:
        """Numbers of the scenarios that need not be run again."""
        return {int(number) for part in self._parts() for number in pd.read_parquet(part)["scenario"]}

    def keep(self, rows: Sequence[Mapping[str, Value]]) -> None:
        first, last = rows[0]["scenario"], rows[-1]["scenario"]
        frame = pd.DataFrame(rows)
        self._write(f"parts/{first:08d}-{last:08d}.parquet", lambda path: frame.to_parquet(path, index=False))

    def finish(self, columns: Sequence[str]) -> tuple[int, int]:
        """Joins the parts; the numbers of good and failed scenarios."""
        frames = [pd.read_parquet(part) for part in self._parts()]
        rows = pd.concat(frames, ignore_index=True).sort_values("scenario", ignore_index=True)
        reasons = rows["reason"] if "reason" in rows else pd.Series(None, index=rows.index, dtype=object)
        rows = rows.reindex(columns=["scenario", *columns])
        good, bad = rows[reasons.isna()], rows[reasons.notna()]
        if len(bad):
            named = [name for name in columns if name in self.plan["variables"]]
            bad = bad[["scenario", *named]].assign(reason=reasons[reasons.notna()])
            self._write("failed.parquet", lambda path: bad.to_parquet(path, index=False))
            self._write("failed.csv", lambda path: bad.to_csv(path, index=False))
        self._write("results.parquet", lambda path: good.to_parquet(path, index=False))
        shutil.rmtree(self.folder / "parts")
        return len(good), len(bad)

    def counts(self) -> tuple[int, int]:
        """The numbers of good and failed scenarios of a whole sweep."""
        failed = self.folder / "failed.parquet"
        good = len(pd.read_parquet(self.folder / "results.parquet", columns=["scenario"]))
        return good, len(pd.read_parquet(failed, columns=["scenario"])) if failed.exists() else 0

    def close(self) -> None:
        """Unlocks; leaves nothing where nothing has been kept."""
        self._remove("lock")
        self._lock.close()
        if not self._parts():
            shutil.rmtree(self.folder / "parts", ignore_errors=True)
            if not self.is_whole():
                self._remove("sweep.json")
        if self._made and not any(self.folder.iterdir()):
            self.folder.rmdir()


@contextlib.contextmanager
def opened(folder: Path, plan: Mapping[str, Value], fresh: bool) -> Iterator[Store]:
    store = Store(folder, plan, fresh)
    try:
        yield store
    finally:
        store.close()
