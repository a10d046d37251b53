"""The folder of a sweep: a Parquet file for every group, written as it comes; a resumed sweep lists them.

    sweep.json        what is being swept
    parts/            groups that have been computed; becomes results.parquet when all are there
    results.parquet/  one row a scenario, in files that pandas and pyarrow read as one
    failed.parquet/   refused scenarios with their reason, if there are any

A file is named after the first and the last scenario of its group, and appears whole or not at all. So two
runs of one sweep at a time do the same work twice, and nothing worse.
"""

import contextlib
from collections.abc import Iterator
from pathlib import Path

from frictioncontact.errors import UserError
from frictioncontact.files import reason, whole_file, write_whole
from frictioncontact.sweeps.workers import Group, Part


class Folder:
    def __init__(self, path: Path, record: str, fresh: bool) -> None:
        """record tells sweeps apart: the folder of another one is refused."""
        self.path, self.parts = path, path / "parts"
        self.results, self.failed = path / "results.parquet", path / "failed.parquet"
        with self._writing():
            path.mkdir(parents=True, exist_ok=True)
            if fresh:
                for folder in (self.parts, self.results, self.failed):
                    _discard(folder)
            known = path / "sweep.json"
            if not known.exists() or known.read_text(encoding="utf-8", errors="replace") != record:
                if self.results.exists() or any([*self.parts.glob("*"), *self.failed.glob("*")]):
                    raise UserError(
                        f"{path}: holds another sweep (other scenarios, groups, sampling or FMU); "
                        "choose another output, or --fresh to discard it"
                    )
                write_whole(known, record)

    def missing(self, groups: list[Group]) -> list[Group]:
        """Those that have to be run, for which parts/ is made ready."""
        there = self.results if self.results.exists() else self.parts
        missing = []
        for first, stop in groups:
            name = _name((first, stop))
            if _rows(there / name) + _rows(self.failed / name) != stop - first:
                missing.append((first, stop))
        with self._writing():
            if missing and self.results.exists():
                self.results.rename(self.parts)
            elif missing:
                self.parts.mkdir(exist_ok=True)
        return missing

    def keep(self, group: Group, part: Part) -> None:
        """The refused scenarios first: with the good ones the group counts as run."""
        contents = [(self.failed, part.bad)] if part.refused else []
        for folder, content in (*contents, (self.parts, part.good)):
            with self._writing(), whole_file(folder / _name(group)) as unfinished:
                unfinished.write_bytes(content)

    def finish(self) -> int:
        """When every group is there: how many scenarios were refused."""
        with self._writing():
            if not self.results.exists():
                self.parts.rename(self.results)
            _discard(self.parts)  # of another run at the same time
            for killed in (*self.results.glob(".*.part"), *self.failed.glob(".*.part")):
                killed.unlink()
        return sum(map(_rows, self.failed.glob("*.parquet")))

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise UserError(f"{self.path}: can't be written: {reason(error)}") from None


def _discard(folder: Path) -> None:
    """What no sweep wrote stays, and is an error."""
    if folder.exists():
        for file in (*folder.glob("*.parquet"), *folder.glob(".*.part")):
            file.unlink()
        folder.rmdir()


def _name(group: Group) -> str:
    return f"{group[0]:010d}-{group[1] - 1:010d}.parquet"


def _rows(file: Path) -> int:
    """None of what is missing or cut short."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        return pq.read_metadata(file).num_rows
    except (OSError, pa.ArrowException):
        return 0
