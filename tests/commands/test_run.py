"""scripts/run: the table it prints and the files it writes."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from frictioncontact import table2
from frictioncontact.command import main
from frictioncontact.parameters import IDENTIFIED, PRINTED, TABLE_2, start_values
from tools.reference import scene_of, settled


@pytest.fixture(scope="module")
def written(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that a whole run wrote to."""
    folder = tmp_path_factory.mktemp("run")
    main(table2, ["--fmu", str(fmu_path), "--output", str(folder)])
    return folder


def test_csv_holds_the_means_of_the_reference(written: Path) -> None:
    table = pd.read_csv(written / "table2.csv")
    assert table["row"].tolist() == [1, 2, 3, 4, 5, 6]
    for line, row in zip(table.to_dict("records"), TABLE_2, strict=True):
        for name, parameters in {"exact": PRINTED, "identified": IDENTIFIED}.items():
            mean = settled(scene_of(start_values(row, parameters)))[0]
            assert line[f"{name}_N"] == pytest.approx(mean, abs=55e-6)  # solver.tolerance times F_C
            assert line[f"{name}_reduction_percent"] == pytest.approx(100 * (1 - mean / 55.0), abs=2e-4)


def test_files_are_written_only_if_asked(
    fmu_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    main(table2, ["--fmu", str(fmu_path)])
    printed = capsys.readouterr().out
    assert list(tmp_path.iterdir()) == [] and "Written" not in printed
    main(table2, ["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path / "new")])
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["table2.csv"]
    assert capsys.readouterr().out.startswith(printed)


def test_an_output_that_is_a_file_is_one_clear_line(fmu_path: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("kept")
    with pytest.raises(SystemExit, match=f"^error: {re.escape(str(tmp_path / 'file'))}[^\n]*$"):
        main(table2, ["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path / "file")])
    assert (tmp_path / "file").read_text() == "kept"
