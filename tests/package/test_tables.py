"""One grammar of tables: dialects of CSV and Python's own tables read alike, in every function."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import frictioncontact as fc
from frictioncontact.tables import factor, table

SI = {"time": [0.0, 1.5e-3, 4e-3], "V": [0.0005, 0.02, -0.03], "F_t": [1000.0, 2250.0, -500.0]}
UNITS = {"time": "s", "V": "m/s", "F_t": "N"}
OWN = {"time": "t", "V [mm/s]": "Geschwindigkeit", "F_t": "Kraft (kN)"}
ROWS, COMMAS = "0,0.5,1\n1.5,20,2.25\n4,-30,-0.5\n", "0;0,5;1\n1,5;20;2,25\n4;-30;-0,5\n"
MICRO, NUMBERED = "0,500,1\n1.5,2e4,2.25\n4,-3e4,-0.5\n", "1;0;0,5;1\n2;1,5;20;2,25\n3;4;-30;-0,5\n"
DIALECTS: dict[str, tuple[str, str, Mapping[str, str] | None]] = {
    "commas": ("time [ms],V [mm/s],F_t [kN]\n" + ROWS, "utf-8", None),
    "decimal commas": ("time [ms];V [mm/s];F_t [kN]\n" + COMMAS, "utf-8", None),
    "tabs, Windows": (
        ("time (ms);V (mm / s);F_t (kN)\n" + COMMAS).replace(";", "\t").replace("\n", "\r\n"), "utf-16", None
    ),
    "a preamble": (
        'Rig "5\ntime;14:02\nOperator;B\n\ntime [ms];V [mm/s];F_t [kN]\n' + COMMAS, "utf-8-sig", None
    ),
    "a row of units": ("time;V;F_t;\nms;mm/s;kN;\n0;0.5;1;\n1.5;20;2.25;\n4;-30;-0.5;\n", "utf-8", None),
    "a header in a remark": ("# time [ms] V [mm/s] F_t [kN]\n" + ROWS.replace(",", " "), "utf-8", None),
    "an index and remarks": (
        ",time [ms],V [mm/s],F_t [kN]\n0,0,0.5,1\n# pause\n1,1.5,20,2.25\n\n2,4,-30,-0.5\n", "utf-8", None
    ),
    "Latin 1": ("time [ms];V [µm/s];F_t [N]\n0;500;1e3\n1,5;2e4;2250\n4;-3e4;-500\n", "cp1252", None),
    "the other mu": ("time [ms],V [\u03bcm\u00b7s\u207b\u00b9],F_t [kN]\n" + MICRO, "utf-8", None),
    "own names": ("no.;t [ms];Geschwindigkeit;Kraft (kN)\n" + NUMBERED, "utf-8", OWN),
    "DIN and ISO headings": ("sep=;\ntime in ms;V / (mm/s);F_t / kN\n" + COMMAS, "utf-8", None),
}  # fmt: skip


@pytest.mark.parametrize("dialect", DIALECTS)
def test_dialects_read_alike(tmp_path: Path, dialect: str) -> None:
    text, encoding, named = DIALECTS[dialect]
    path = tmp_path / "log.csv"
    path.write_bytes(text.encode(encoding))
    with warnings.catch_warnings():
        warnings.simplefilter("error" if named is None else "ignore")
        found = table(path, "data", UNITS, "column", named).numbers()
    assert {name: values.tolist() for name, values in found.items()} == {
        name: pytest.approx(values, rel=1e-15) for name, values in SI.items()
    }


AS_WRITTEN = """um m 1e-6|µm m 1e-6|μm m 1e-6|mm / s m/s 1e-3|(mm/s) m/s 1e-3|N·s/m N.s/m 1|Ns/m N.s/m 1
kN N 1e3|mN N 1e-3|° rad 0.017453292519943295|deg rad 0.017453292519943295|kHz Hz 1e3|mm² m2 1e-6|mm2 m2 1e-6
1/mm2 1/m2 1e6|N/mm N/m 1e3|GPa Pa 1e9|km/h m/s 0.2777777777777778|m s-1 m/s 1|% 1 0.01"""


def test_units_as_people_write_them() -> None:
    for one in AS_WRITTEN.replace("\n", "|").split("|"):
        unit, si, size = one.rsplit(" ", 2)
        assert factor(unit, si, "") == pytest.approx(float(size), rel=1e-14), one
    # Of another kind, also where a library of units would convert by a factor of 2 pi, in silence.
    for unit, si in (("rad/s", "Hz"), ("rpm", "Hz"), ("%", "rad"), ("kg", "N"), ("furlong/", "m")):
        with pytest.raises(fc.UserError, match=re.escape(f"V takes a unit like {si}, not {unit!r}")):
            factor(unit, si, "V")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time;V;F_t\n0,5;1.5;2\n", "log.csv: has decimal commas and decimal points, as in '1.5'; write one"),
        ("time;V;F_t\n1;2;1.234,5\n", "row 1 (line 2), column 'F_t': '1.234,5' is not a number"),
        ("time;V\nms;mm/h/s\n1;2\n", "line 1, column 2: V takes a unit like m/s, not 'mm/h/s'"),
        ("t;v\n1;2\n", "log.csv, line 1, column 1: t is no column; these are: time, V, F_t"),
        ("time;V;V\n1;2;3\n", "line 1, column 3: V is there twice"),
        ("time;V\n1;2;3\n", "row 1 (line 2): 3 cells, but 2 columns"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(fc.UserError, match=re.escape(message)):
        table(path, "data", UNITS, "column").numbers()
    path.write_bytes(b"time,V\n\0\1\2")
    with pytest.raises(fc.UserError, match="is not a CSV file: its bytes are no text"):
        table(path, "data", UNITS, "column")


def test_a_heading_that_is_not_there_and_a_column_that_is_not_used() -> None:
    data = {"t": [0.0], "v": [1.0], "T [K]": [300.0]}
    with pytest.raises(fc.UserError, match="column V: there is no heading 'speed'; these are: t, v"):
        table(data, "data", UNITS, "column", {"V": "speed", "time": "t"})
    with pytest.warns(fc.FrictionWarning, match="data: column 'T"):
        found = table(data, "data", UNITS, "column", {"V [mm/s]": "v", "time": "t"}).numbers()
    assert found["V"] == pytest.approx([1e-3])


LAW = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
V, TIME = np.array([3e-4, -3e-4, 3e-4, 3e-4]), np.array([0.0, 0.1, 0.2, 0.4])
WAYS: dict[str, Callable[[Mapping[str, Any], Path], Any]] = {
    "a frame": lambda data, path: pd.DataFrame(data),
    "a file": lambda data, path: pd.DataFrame(data).to_csv(path, index=False) or str(path),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_function_takes_the_same_tables(fmu_path: Path, tmp_path: Path, way: str) -> None:
    def given(data: Mapping[str, Any]) -> Any:
        return WAYS[way](data, tmp_path / "table.csv")

    si = {"time": TIME, "V": V}
    plain = fc.simulate(LAW, stop=0.4, step=0.01, inputs=si, outputs=["F_t"], fmu=fmu_path)
    drive = given({"time [ms]": 1e3 * TIME, "V [mm/s]": 1e3 * V})
    units = fc.simulate(LAW, stop=0.4, step=0.01, inputs=drive, outputs=["F_t"], fmu=fmu_path)
    assert units["F_t"].to_numpy() == pytest.approx(plain["F_t"].to_numpy(), abs=1e-9)
    even = given({"time [ms]": [0.0, 1.0, 2.0], "V [mm/s]": [1.0, 2.0, 3.0]})
    si = {"time": [0.0, 1e-3, 2e-3], "V": [1e-3, 2e-3, 3e-3]}
    advised = [fc.advise(LAW, inputs=inputs, fmu=fmu_path) for inputs in (even, si)]
    assert advised[0].settings == advised[1].settings and advised[0].mean == pytest.approx(advised[1].mean)
    record = given(
        {
            "time [ms]": 1e3 * plain["time"],
            "V [mm/s]": 1e3 * np.interp(plain["time"], TIME, V),
            "F_t [kN]": 1e-3 * plain["F_t"],
        }
    )
    found = fc.identify(record, "F_C", start=LAW, fmu=fmu_path)
    assert found.values["F_C"] == pytest.approx(55.0, rel=1e-3)


def test_many_scenarios_with_units(fmu_path: Path) -> None:
    plain = {"V": np.array([[0.1], [0.2]]), "vibration.f": 2e4, "vibration.V_1": [0.5, 1.0]}
    units = {"V [mm/s]": 1e3 * plain["V"], "vibration.f [kHz]": 20.0, "vibration.V_1": [0.5, 1.0]}
    expected = fc.simulate_many(plain, fmu=fmu_path)["F_t_mean"]
    assert fc.simulate_many(units, fmu=fmu_path)["F_t_mean"] == pytest.approx(expected, rel=1e-12)
    frame = pd.DataFrame({"V [mm/s]": [100.0, 200.0]})
    assert len(fc.simulate_many(frame, fmu=fmu_path)) == 2
    with pytest.raises(fc.UserError, match="column V takes a unit like m/s, not 'mm'"):
        fc.simulate_many({"V [mm]": 1.0}, fmu=fmu_path)
    with pytest.raises(fc.UserError, match="column V: is there twice"):
        fc.simulate_many({"V [mm/s]": 1.0, "V": 1.0}, fmu=fmu_path)


def test_a_position_moves_the_contact_as_far_as_it_says(fmu_path: Path) -> None:
    """Stuck, F = sigma x from rest; at rest before the first sample and after the last."""
    scene = {**LAW, "contact.sigma": 1e6, "V": 0.0}
    drive = {"time [ms]": [1.0, 2.0, 4.0], "position [um]": [5.0, 15.0, 8.0]}
    found = fc.simulate(scene, stop=6e-3, step=1e-3, inputs=drive, outputs=["F_t"], fmu=fmu_path)["F_t"]
    assert found[[0, 1, 2, 4, 5, 6]].tolist() == pytest.approx([0.0, 0.0, 10.0, 3.0, 3.0, 3.0], abs=1e-5)
    both = {"time": [0.0, 1.0], "position": [0.0, 1.0], "V": [0.0, 1.0]}
    with pytest.raises(fc.UserError, match="inputs: position needs two samples, a time that grows, and no V"):
        fc.simulate(stop=1.0, step=0.1, inputs=both, fmu=fmu_path)


def test_samples_beyond_the_end_are_told(fmu_path: Path) -> None:
    drive = {"time": [0.0, 500.0, 1000.0], "V": [0.1, 0.1, 0.1]}
    with pytest.warns(
        fc.FrictionWarning, match="inputs: 2 of 3 samples are after stop = 1 s; the last is at 1000 s"
    ):
        fc.simulate(stop=1.0, step=0.1, inputs=drive, fmu=fmu_path)


RECORD = {"time": [0.0, 1e-3, 2e-3], "position": [1e-6, 2e-6, 4e-6], "F_t": [1.0, 2.5, -3.0]}
ROWS_OF_MEANS = {"V": [1e-3, 2e-3, 4e-3], "F_t_mean": [1.0, 2.5, -3.0]}
LOGS: dict[str, tuple[str, dict[str, list[float]], str]] = {
    "capitals": ("TIME (MS),DISP. (UM),FX (N)\n0,1,1\n1,2,2.5\n2,4,-3\n", RECORD, "'FX (N)' is taken as F_t"),
    "short": ("t;pos;Force\n0;1e-6;1\n1e-3;2e-6;2.5\n2e-3;4e-6;-3\n", RECORD, "'pos' is taken as position"),
    "units at the end": ("Time_ms,x_um,Force_mN\n0,1,1e3\n1,2,2500\n2,4,-3e3\n", RECORD, "taken as F_t [mN]"),
    "a preamble and units below": (
        '"Rig 3","2026-02-03"\n"Time","Displacement","Force","Temp."\n"(s)","(mm)","(kN)","(°C)"\n'
        '"0","0.001","0.001","21"\n"0.001","0.002","0.0025",""\n"0.002","0.004","-0.003","21"\n',
        RECORD,
        "'Temp. [°C]' is not used",
    ),
    "cells without a value": (
        "Time [s],Disp. [um],Force [N],RPM\n0,1,1,\n1e-3,2,2.5,\n1.5e-3,,2,\n1.7e-3,3,NaN,\n2e-3,4,-3,\n",
        RECORD,
        "2 of 5 rows have no value and are left out",
    ),
    "means": ("Speed [mm/s],Force\n1,1\n2,2.5\n4,-3\n", ROWS_OF_MEANS, "'Force' is taken as F_t_mean"),
}  # fmt: skip


@pytest.mark.parametrize("log", LOGS)
def test_logs_are_read_as_they_are(tmp_path: Path, log: str) -> None:
    text, expected, said = LOGS[log]
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    units = {"time": "s", "position": "m", "F_t": "N", "F_t_mean": "N", "V": "m/s", "load": "N"}
    with pytest.warns(fc.FrictionWarning, match=re.escape(said)):
        found = table(path, "data", units, "column", is_log=True).numbers()
    assert {name: values.tolist() for name, values in found.items()} == {
        name: pytest.approx(values, rel=1e-14) for name, values in expected.items()
    }


def test_a_log_that_may_mean_two_things_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,pos,disp,F_t\n0,1,1,1\n")
    with pytest.raises(fc.UserError, match="'pos' and 'disp' look like position; name one by an option"):
        table(path, "data", {"position": "m", "time": "s", "F_t": "N"}, "column", is_log=True)


def test_times_of_a_log_in_any_order(fmu_path: Path) -> None:
    """Sorted, and doubles averaged: the fit is that of the log in order."""
    x = np.concatenate([np.linspace(0, 20e-6, 41), np.linspace(20e-6, -20e-6, 41)[1:]])
    force = np.clip(np.concatenate([2e6 * x[:41], 20 + 2e6 * (x[41:] - 20e-6)]), -20, 20)
    time, start = 0.01 * np.arange(len(x)), {**LAW, "contact.sigma": 2e6}
    log = {"time": time, "position": x, "F_t": force}
    mixed = [*np.random.default_rng(1).permutation(len(x)), 3]
    data = {name: each[mixed] for name, each in log.items()}
    with pytest.warns(fc.FrictionWarning, match="time falls or stands at .* 1 times are there more than"):
        found = fc.identify(data, "F_C", start=start, fmu=fmu_path)
    assert found.values["F_C"] == pytest.approx(20.0, rel=1e-4)
    with pytest.warns(fc.FrictionWarning, match="no time: a delay, a drift and hum are not seen"):
        found = fc.identify({"position": x, "F_t": force}, "F_C", start=start, fmu=fmu_path)
    assert found.values["F_C"] == pytest.approx(20.0, rel=1e-4) and "late" not in str(found)
    with pytest.raises(fc.UserError, match=r"is missing, and friction\.sigma_2 needs it"):
        fc.identify(
            {"position": x, "F_t": force}, "F_C", start=start | {"friction.sigma_2": 5.0}, fmu=fmu_path
        )
    with pytest.warns(fc.FrictionWarning, match="position spans 40 m, an unlikely magnitude"):
        fc.identify(log | {"position": 1e6 * x}, "F_C", start=start, fmu=fmu_path)
