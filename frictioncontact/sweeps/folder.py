"""The folder of a sweep: a Parquet file for every group, written as it comes; a resumed sweep lists them.

    sweep.json        what is being swept
    parts/            groups that have been computed; becomes results.parquet when all are there
    results.parquet/  one row a scenario, in files that pandas and pyarrow read as one
    failed.parquet/   refused scenarios with their reason, if there are any
    failed.csv        the same to read, at the end

A file is named after the first and the last scenario of its group.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
from pyarrow import csv

from frictioncontact.errors import UserError
from frictioncontact.files import whole_file, write_whole
from frictioncontact.sweeps.group import Part
from frictioncontact.values import Value

try:
    import fcntl
except ImportError:  # Windows: two sweeps into one folder would only do the same work twice
    fcntl = None

Group = tuple[int, int]  # first scenario, and the one after the last


def _name(group: Group) -> str:
    return f"{group[0]:010d}-{group[1] - 1:010d}.parquet"


@contextlib.contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise UserError(f"{path}: can't be written: {error.strerror or error}") from None


def _rows(part: Path) -> int:
    """Of a Parquet file, which is read to its last page; -1 where a part of it is damaged."""
    try:
        return len(pq.read_table(part, page_checksum_verification=True, partitioning=None))
    except (OSError, pa.ArrowException):
        return -1


class Folder:
    """The files of a sweep; `opened` locks them."""

    def __init__(self, path: Path) -> None:
        self.path, self.record = path, path / "sweep.json"
        self.parts, self.results = path / "parts", path / "results.parquet"
        self.failed, self.failed_csv = path / "failed.parquet", path / "failed.csv"

    def take_up(self, record: Mapping[str, Value], fresh: bool) -> None:
        """record is what sweep.json holds; another sweep's folder, whose "digest" differs, is refused."""
        with _writing(self.path):
            for unfinished in (*self.path.glob(".*.part"), *self.path.glob("*/.*.part")):
                unfinished.unlink()
            if fresh:
                for old in (self.results, self.parts, self.failed, self.failed_csv, self.record):
                    _remove(old)
        if self.record.exists() or self.results.exists() or self.parts.exists():
            if _digest(self.record) != record["digest"]:
                raise UserError(
                    f"{self.path}: holds another sweep (other scenarios, groups, sampling or FMU); "
                    "choose another --output, or --fresh to discard it"
                )
        else:
            with _writing(self.record):
                write_whole(self.record, json.dumps(record, indent=2) + "\n")
        if not self.results.exists():
            with _writing(self.parts):
                self.parts.mkdir(exist_ok=True)

    def is_begun(self) -> bool:
        """Whether some group has been computed, but not all."""
        return self.parts.exists() and any(self.parts.iterdir())

    def missing(self, groups: list[Group]) -> list[Group]:
        """Those that have to be run: they are not there, or a file of theirs is damaged."""
        there = self.results if self.results.exists() else self.parts
        good, bad = ({path.name for path in folder.glob("*.parquet")} for folder in (there, self.failed))
        missing = []
        for group in groups:
            name = _name(group)
            rows = _rows(there / name) if name in good else -1
            refused = _rows(self.failed / name) if name in bad else 0
            if min(rows, refused) < 0 or rows + refused != group[1] - group[0]:
                missing.append(group)
        if missing and there == self.results:
            with _writing(self.parts):
                self.results.rename(self.parts)
        return missing

    def keep(self, group: Group, part: Part) -> None:
        """The refused scenarios first: a group counts as run when its good ones are there."""
        name = _name(group)
        for folder, content in ((self.failed, part.bad), (self.parts, part.good)):
            if content is not None:
                with _writing(folder / name), whole_file(folder / name) as unfinished:
                    unfinished.write_bytes(content)

    def finish(self) -> None:
        """When every group is there."""
        failed = sorted(self.failed.glob("*.parquet"))
        if failed and not self.results.exists():
            csv_file = self.failed_csv
            with _writing(csv_file), whole_file(csv_file) as unfinished, contextlib.ExitStack() as stack:
                writer = None
                for part in failed:
                    table = pq.read_table(part)
                    writer = writer or stack.enter_context(csv.CSVWriter(str(unfinished), table.schema))
                    writer.write_table(table)
        with _writing(self.results):
            if not self.results.exists():
                self.parts.rename(self.results)

    def refused(self) -> int:
        """How many scenarios."""
        return sum(pq.read_metadata(part).num_rows for part in self.failed.glob("*.parquet"))

    def tidy(self) -> None:
        """Leaves nothing where nothing has been kept."""
        if self.parts.exists() and not self.is_begun():
            self.parts.rmdir()
            self.record.unlink()


@contextlib.contextmanager
def opened(path: Path, record: Mapping[str, Value], fresh: bool) -> Iterator[Folder]:
    """The folder of a new sweep or of one to be gone on with, locked against other sweeps."""
    made = not path.exists()
    with _writing(path):
        path.mkdir(parents=True, exist_ok=True)
    try:
        with _locked(path):
            folder = Folder(path)
            folder.take_up(record, fresh)
            try:
                yield folder
            finally:
                folder.tidy()
    finally:
        if made:
            with contextlib.suppress(OSError):  # it holds something
                path.rmdir()


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    if fcntl is None:
        yield
        return
    lock = os.open(path, os.O_RDONLY)
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UserError(f"{path}: another sweep is writing there") from None
        yield
    finally:
        os.close(lock)


def _digest(record: Path) -> object:
    try:
        return json.loads(record.read_text(encoding="utf-8"))["digest"]
    except (OSError, ValueError, KeyError, TypeError):
        raise UserError(
            f"{record}: is damaged or missing; choose another --output, "
            "or --fresh to discard what the folder holds"
        ) from None


def _remove(path: Path) -> None:
    """A file, or the Parquet files of a folder and then itself."""
    if path.is_dir():
        for part in path.glob("*.parquet"):
            part.unlink()
        path.rmdir()
    else:
        path.unlink(missing_ok=True)
