"""identify on data of the independent reference, with one fault of an instrument or of the request."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import frictioncontact as fc
from workshop.reference import after, scene, settled, step

V = np.geomspace(1e-3, 0.5, 12)  # m/s
F, V_1 = 28.4e3, 0.2141  # Hz, m/s
DAHL = {"contact.model": "Constant"}
ELASTIC = {**DAHL, "friction.model": "ElasticPlastic"}
FIT = ["contact.sigma", "F_C"]


@pytest.fixture(scope="module")
def rows() -> pd.DataFrame:
    """Means of ElasticPlastic, 12e6 N/m and 18 N, without and with a vibration; scatter 0.15 N."""
    values = [(v, a) for v in V for a in (0.0, V_1)]
    law = {"law": "ElasticPlastic", "contact": "Constant", "F_C": 18.0, "contact_sigma": 12e6}
    exact = [settled(scene(**law, f=F, V=v, V_1=a))[0] for v, a in values]
    force = np.array(exact) + 0.15 * np.random.default_rng(24).standard_normal(len(exact))
    frame = pd.DataFrame(1e3 * np.array(values), columns=["V [mm/s]", "vibration.V_1 [mm/s]"])
    return frame.assign(**{"vibration.f [kHz]": 1e-3 * F, "F_t_mean [N]": force})


def test_a_wrong_law_and_a_wrong_amplitude_are_named(rows: pd.DataFrame, fmu_path: Path) -> None:
    """Dahl's, without a stated uncertainty: half of the rows, without vibration, fit."""
    data = rows.sort_values("vibration.V_1 [mm/s]", kind="stable")
    found = fc.identify(data, FIT, start=DAHL, fmu=fmu_path)
    assert "the misfit of the rows with vibration.V_1 = 0.2141, " in found.misfits[0]
    assert found.remedies[0].startswith(
        "it fits with friction.model = ElasticPlastic; then contact.sigma = 1."
    )
    assert repr(found).endswith("; 1 misfit>")
    assert f"MISFIT: {found.misfits[0]}\n\nPERHAPS {found.remedies[0]}" in str(found)
    doubled = rows.assign(**{"vibration.V_1 [mm/s]": 2.0 * rows["vibration.V_1 [mm/s]"]})
    found = fc.identify(doubled, FIT, start=ELASTIC, fmu=fmu_path)
    assert "half the stated vibration.V_1: is that from peak to peak?" in found.remedies[0]


def test_whether_rows_were_judged_is_said(rows: pd.DataFrame, fmu_path: Path) -> None:
    """ElasticPlastic's mean minus F_C does not depend on F_C: an offset is not seen."""
    open_, judged = (
        fc.identify(rows, FIT, start=ELASTIC, uncertain=stated, fmu=fmu_path)
        for stated in (None, {"F_t_mean": 0.15})
    )
    assert repr(open_).endswith("; fit not judged>") and "whether the law fits is open" in str(open_)
    assert repr(judged).endswith("; it fits>") and str(judged).startswith("The law fits: ")
    assert "would not show an offset of the force or a wrong gain of the force of a tenth" in str(judged)
    for found in (open_, judged):
        low, high = found.intervals["contact.sigma"]
        assert found.misfits == [] and low < 12e6 < high


LATE, OFFSET, DRIFT = 13e-3, 0.6, 0.12  # s, N, N/s


@pytest.fixture(scope="module")
def rig_record() -> pd.DataFrame:
    """A loop of Dahl's, 2.2e6 N/m and 18 N, from within presliding to beyond, as a bad rig writes it."""
    random, time = np.random.default_rng(4), np.linspace(0.0, 1.8, 1199)
    w = 2.0 * np.pi * 2.1 / 1.8
    V = np.gradient(5.7e-5 * np.sin(w * time) * (0.15 + 0.47 * time), time, edge_order=2)
    h, rate, force = time[1], np.diff(V) / time[1], [0.0]
    now = scene(contact="Constant", F_C=18.0, contact_sigma=2.2e6, V=V[0], V_rate=rate[0], h=h)
    before = None
    for k in range(len(rate)):
        found = step(now, before)
        force.append(found.F_t)
        if k + 1 < len(rate):
            before, now = after(now, found, V=V[k + 1], V_rate=rate[k + 1])
    x = 1e6 * np.concatenate([[0.0], np.cumsum(0.5 * (V[1:] + V[:-1]) * h)])
    time, x, force = time[::2], x[::2], np.array(force[::2])
    late = np.interp(time - LATE, time, force, left=0.0) + OFFSET + DRIFT * time
    noise = random.standard_normal((2, len(time)))
    return pd.DataFrame(
        {"t / ms": 1e3 * time, "x (µm)": x + 0.02 * noise[1], "Kraft": late + 0.12 * noise[0]}
    )


COLUMNS = {"time": "t / ms", "position": "x (µm)", "F_t": "Kraft"}


def test_faults_of_an_instrument_are_named_with_their_sizes(
    rig_record: pd.DataFrame, tmp_path: Path, fmu_path: Path
) -> None:
    path = tmp_path / "rig.csv"
    rig_record.round(5).to_csv(path, sep=";", decimal=",", index=False)
    found = fc.identify(path, FIT, start=DAHL, columns=COLUMNS, fmu=fmu_path)
    assert "times the scatter of neighbouring samples" in found.misfits[0]
    for words in ("offset +0.", "drift +0.", "delay +1", "(nuisance "):
        assert words in found.remedies[0]
    asked = ["offset", "drift", "delay"]
    fitted = fc.identify(path, FIT, start=DAHL, columns=COLUMNS, nuisance=asked, fmu=fmu_path)
    assert repr(fitted).endswith("; it fits>")
    truth = {"offset": OFFSET, "drift": DRIFT, "delay": LATE}
    for name, (value, width) in fitted.nuisances.items():
        assert abs(value - truth[name]) < 1.5 * width, name
    for name, right in (("contact.sigma", 2.2e6), ("F_C", 18.0)):
        low, high = fitted.intervals[name]
        assert low < right < high and high < 1.1 * low, name
    assert "the measured position scatters by " in str(fitted)
    assert fitted.plot().axes[0].get_xlabel() == "time [s]"


def test_a_force_of_the_other_sign(rows: pd.DataFrame, fmu_path: Path) -> None:
    flipped = rows.assign(**{"F_t_mean [N]": -rows["F_t_mean [N]"]})
    one, other = (
        fc.identify(data, FIT, start=ELASTIC, nuisance="sign", fmu=fmu_path) for data in (rows, flipped)
    )
    assert other.values == pytest.approx(one.values, rel=1e-6)
    assert one.nuisances == {} and other.nuisances == {"sign": (-1.0, 0.0)}
