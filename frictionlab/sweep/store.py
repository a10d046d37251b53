"""The folder of a sweep: results are kept as they come, so that a killed sweep goes on where it was.

    sweep.json        what is being swept
    parts/*.parquet   rows that have been computed; gone when the sweep is whole
    work/             what its processes here need while they run
    results.parquet   at the end: one row a scenario
    failed.parquet    at the end, if any failed: scenarios with their reason (failed.csv: the same to read)

Every file is written under another name and renamed when whole. Memory holds one group of rows at a time.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from pyarrow import csv

from frictionlab.project import UserError
from frictionlab.sweep.scenario import Results
from frictionlab.sweep.spans import Span
from frictionlab.values import Value

GROUP = 100_000  # rows of a group in the joined files, at least


class Store:
    """The folder, locked against other sweeps while it is open."""

    def __init__(self, folder: Path, plan: Mapping[str, Value], fresh: bool) -> None:
        """plan is what sweep.json holds; of another sweep's folder its "digest" differs, which is refused."""
        self.folder = folder
        self.plan = dict(plan)
        self._made = not folder.exists()
        self._is_ours = False  # what is in the folder is of this sweep
        try:
            (folder / "parts").mkdir(parents=True, exist_ok=True)
            self._lock = (folder / "lock").open("w")
        except OSError as error:
            raise UserError(f"{folder}: can't be written to: {error.strerror}") from None
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._lock.close()
            raise UserError(f"{folder}: another sweep is writing there") from None
        try:
            self._take_up(fresh)
        except UserError:
            self.close()
            raise

    def _take_up(self, fresh: bool) -> None:
        if fresh:
            self._remove("results.parquet", "failed.parquet", "failed.csv", "sweep.json")
            for part in self._parts():
                part.unlink()
        for unfinished in (*self.folder.glob("*.unfinished"), *self.folder.glob("parts/*.unfinished")):
            unfinished.unlink()
        shutil.rmtree(self.work, ignore_errors=True)
        if (self.folder / "sweep.json").exists():
            if self._begun_digest() != self.plan["digest"]:
                raise UserError(
                    f"{self.folder}: holds another sweep (other scenarios, sampling or FMU); "
                    "choose another --output, or --fresh to discard it"
                )
        else:
            text = json.dumps(self.plan, indent=2) + "\n"
            self._write("sweep.json", lambda path: path.write_text(text))
        self.work.mkdir()
        self._is_ours = True

    def _begun_digest(self) -> object:
        record = self.folder / "sweep.json"
        try:
            begun = json.loads(record.read_text())
            return begun["digest"]
        except (OSError, ValueError, KeyError, TypeError):
            raise UserError(
                f"{record}: is damaged; choose another --output, or --fresh to discard what the folder holds"
            ) from None

    @property
    def work(self) -> Path:
        return self.folder / "work"

    def _parts(self) -> list[Path]:
        return sorted((self.folder / "parts").glob("*.parquet"), key=_span)

    def _remove(self, *names: str) -> None:
        for name in names:
            (self.folder / name).unlink(missing_ok=True)

    def _write(self, name: str, write: Callable[[Path], object]) -> None:
        unfinished = self.folder / f"{name}.unfinished"
        try:
            write(unfinished)
            with unfinished.open("rb") as file:
                os.fsync(file.fileno())
            unfinished.replace(self.folder / name)
        except BaseException as error:
            with contextlib.suppress(OSError):
                unfinished.unlink()
            if isinstance(error, OSError):
                reason = error.strerror or error
                raise UserError(f"{self.folder / name}: can't be written: {reason}") from None
            raise

    def is_whole(self) -> bool:
        return (self.folder / "results.parquet").exists()

    def done(self) -> list[Span]:
        """Scenarios that need not be run again. A part that can't be read is discarded."""
        spans = []
        for part in self._parts():
            first, stop = _span(part)
            try:
                whole = pq.read_metadata(part).num_rows == stop - first
            except (OSError, pa.ArrowException):
                whole = False
            if whole:
                spans.append((first, stop))
            else:
                part.unlink()
        return spans

    def keep(self, span: Span, values: Mapping[str, np.ndarray], results: Results) -> None:
        """The rows of consecutive scenarios."""
        first, stop = span
        reasons = pa.nulls(stop - first, pa.string())
        if results.reasons:
            reasons = pa.array([results.reasons.get(row) for row in range(stop - first)], pa.string())
        table = pa.table(
            {
                "scenario": np.arange(first, stop),
                **{name: _arrow(column) for name, column in values.items()},
                **results.columns,
                "reason": reasons,
            }
        )
        self._write(f"parts/{first:08d}-{stop - 1:08d}.parquet", lambda path: _write_part(table, path))

    def finish(self, results: Sequence[str], check: Callable[[], None]) -> tuple[int, int]:
        """Joins the parts; the numbers of good and failed scenarios. Calls check often: it may raise."""

        def join(name: str, writer: Callable, chosen: Callable[[pa.Table], pa.Table]) -> int:
            def checked(table: pa.Table) -> pa.Table:
                check()
                return chosen(table)

            return self._join(name, writer, checked)

        good = bad = 0
        if any(_has_failed(part) for part in self._parts()):
            bad = join("failed.parquet", _parquet_writer, lambda table: _failed(table, results))
            join("failed.csv", csv.CSVWriter, lambda table: _failed(table, results))
        good = join("results.parquet", _parquet_writer, _good)
        shutil.rmtree(self.folder / "parts")
        return good, bad

    def _groups(self) -> Iterator[pa.Table]:
        tables: list[pa.Table] = []
        for part in self._parts():
            tables.append(pq.read_table(part))
            if sum(table.num_rows for table in tables) >= GROUP:
                yield pa.concat_tables(tables).combine_chunks()
                tables = []
        if tables:
            yield pa.concat_tables(tables).combine_chunks()

    def _join(self, name: str, writer: Callable, chosen: Callable[[pa.Table], pa.Table]) -> int:
        """Writes the chosen rows of all groups, a group at a time; how many they are."""
        rows = 0

        def write(path: Path) -> None:
            nonlocal rows
            with contextlib.ExitStack() as stack:
                file = None
                for group in self._groups():
                    table = chosen(group)
                    if file is None:
                        file = stack.enter_context(writer(str(path), table.schema))
                    if table.num_rows:
                        file.write_table(table)
                        rows += table.num_rows

        self._write(name, write)
        return rows

    def counts(self) -> tuple[int, int]:
        """The numbers of good and failed scenarios of a whole sweep."""
        failed = self.folder / "failed.parquet"
        good = pq.read_metadata(self.folder / "results.parquet").num_rows
        return good, pq.read_metadata(failed).num_rows if failed.exists() else 0

    def close(self) -> None:
        """Unlocks; leaves nothing where nothing has been kept."""
        shutil.rmtree(self.work, ignore_errors=True)
        self._remove("lock")
        self._lock.close()
        if not self._parts():
            shutil.rmtree(self.folder / "parts", ignore_errors=True)
            if self._is_ours and not self.is_whole():
                self._remove("sweep.json")
        if self._made and not any(self.folder.iterdir()):
            self.folder.rmdir()


def _span(part: Path) -> Span:
    first, _, last = part.stem.partition("-")
    return int(first), int(last) + 1


def _has_failed(part: Path) -> bool:
    reasons = pq.read_table(part, columns=["reason"])["reason"]
    return reasons.null_count < len(reasons)


def _parquet_writer(path: str | Path, schema: pa.Schema, compression: str = "SNAPPY") -> pq.ParquetWriter:
    """Dictionaries serve names alone: numbers seldom come twice."""
    names = [field.name for field in schema if pa.types.is_string(field.type)]
    return pq.ParquetWriter(str(path), schema, use_dictionary=names, compression=compression)


def _write_part(table: pa.Table, path: Path) -> None:
    """Not compressed: it is read once and gone."""
    with _parquet_writer(path, table.schema, "NONE") as file:
        file.write_table(table)


def _arrow(column: np.ndarray) -> pa.Array:
    return pa.array(column, pa.string() if column.dtype == object else None)


def _good(table: pa.Table) -> pa.Table:
    return table.filter(pc.is_null(table["reason"])).drop_columns("reason")


def _failed(table: pa.Table, results: Sequence[str]) -> pa.Table:
    return table.filter(pc.is_valid(table["reason"])).drop_columns(list(results))


@contextlib.contextmanager
def opened(folder: Path, plan: Mapping[str, Value], fresh: bool) -> Iterator[Store]:
    store = Store(folder, plan, fresh)
    try:
        yield store
    finally:
        store.close()
