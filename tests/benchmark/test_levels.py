"""bench/levels: where simpler laws and contacts fail."""

from __future__ import annotations

from pathlib import Path

import pandas
import pytest

from frictioncontact.command import main
from tools.bench import levels


def test_the_table_of_scenes_shows_where_simpler_models_fail(
    fmu_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the scenes one of each kind."""
    kinds = {case.name: case for case in levels.scenes()}
    chosen = [kinds[name] for name in ("steady", "presliding", "stick-slip", "soft")]
    monkeypatch.setattr(levels, "scenes", lambda: chosen)
    main(levels, ["--quick", "--fmu", str(fmu_path), "--output", str(tmp_path)])
    assert "presliding" in capsys.readouterr().out
    table = pandas.read_csv(tmp_path / "levels.csv", index_col="scene")
    errors = table.map(lambda cell: max(map(float, cell.split(", "))))
    assert (errors["default at 1e-3"] <= 1e-3).all()
    assert errors["Coulomb"]["presliding hysteresis"] > 0.1
    assert errors["Coulomb"]["stick-slip on a belt"] > 0.1
    assert errors["contact Constant"]["soft contact, V and d vibrate"] > 0.1
