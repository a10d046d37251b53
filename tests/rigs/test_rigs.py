"""identify on data of the independent reference, with one fault of an instrument or of the request."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.signal import butter, lfilter

import frictioncontact as fc
from tools.reference import after, scene, settled, step

V = np.geomspace(1e-3, 0.5, 12)  # m/s
F, V_1 = 28.4e3, 0.2141  # Hz, m/s
DAHL = {"contact.model": "Constant"}
ELASTIC = {**DAHL, "friction.model": "ElasticPlastic"}
FIT = ["contact.sigma", "F_C"]
RIGS = 2  # of each kind


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
    assert "would not show an offset of the force, a wrong gain of the force, each of a tenth" in str(judged)
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
    assert [axes.get_xlabel() for axes in fitted.plot().axes] == [
        "position [µm]",
        "contact.sigma [N/m]",
        "time [s]",
        "frequency [Hz]",
    ]


def test_a_force_of_the_other_sign(rows: pd.DataFrame, fmu_path: Path) -> None:
    flipped = rows.assign(**{"F_t_mean [N]": -rows["F_t_mean [N]"]})
    one, other = (
        fc.identify(data, FIT, start=ELASTIC, nuisance="sign", fmu=fmu_path) for data in (rows, flipped)
    )
    assert other.values == pytest.approx(one.values, rel=1e-6)
    assert one.nuisances == {} and other.nuisances == {"sign": (-1.0, 0.0)}


def test_an_amplitude_that_the_rows_can_not_tell_is_said_first() -> None:
    """Vibrated rows alone: a velocity from peak to peak fits as well, with another F_C."""
    V = np.geomspace(5e-5, 60e-3, 12)
    law = {"law": "ElasticPlastic", "contact": "Constant", "F_C": 14.0, "contact_sigma": 5.5e6, "f": 31e3}
    exact = np.array([settled(scene(**law, V=v, V_1=0.35))[0] for v in V])
    force = exact + 0.1 * np.random.default_rng(7).standard_normal(len(V))
    for factor in (2.0, 0.5):
        data = {"V": V, "vibration.V_1": np.full(12, 0.35 * factor), "F_t_mean": force}
        start = ELASTIC | {"vibration.f": 31e3}
        found = fc.identify(data, FIT, start=start, uncertain={"F_t_mean": 0.1})
        words = (
            "half the stated vibration.V_1: is that from"
            if factor == 2.0
            else "twice the stated vibration.V_1"
        )
        (line,) = [text for text in found.remedies if words in text]
        assert found.misfits == [] and f"BUT {line}" in str(found).split("Fitted parameters")[0]
        assert 13.0 < float(line.partition("F_C = ")[2].partition(" N")[0]) < 15.0
    with pytest.raises(fc.UserError, match="nuisance amplitude: is for rows of means with a column"):
        fc.identify({"V": V, "F_t_mean": force}, "F_C", nuisance="amplitude")


def test_the_amplitude_as_a_nuisance(rows: pd.DataFrame, fmu_path: Path) -> None:
    """Rows without vibration give F_C, and so the others the amplitude."""
    doubled = rows.assign(**{"vibration.V_1 [mm/s]": 2.0 * rows["vibration.V_1 [mm/s]"]})
    found = fc.identify(doubled, FIT, start=ELASTIC, nuisance="amplitude", fmu=fmu_path)
    value, width = found.nuisances["amplitude"]
    assert found.misfits == [] and abs(value - 0.5) < 1.5 * width < 0.1


def loop(random: np.random.Generator, law: str, noise: str) -> tuple[dict[str, np.ndarray], float]:
    """A loop of a rate-independent law by its closed form from sample to sample, and its limit.

    Presliding and sliding at 0.5 to 3 Hz, 500 samples; noise of 0.2 to 3 % of the limit: white, behind a
    filter of second order at 0.25 to 0.9 of Nyquist's frequency, or hum.
    """
    time, limit = np.linspace(0.0, 4.0, 500), random.uniform(3.0, 60.0)
    sigma = 10.0 ** random.uniform(5.7, 7.0)
    x = limit / sigma * random.uniform(1.5, 6.0) * np.sin(2.0 * np.pi * random.uniform(0.5, 3.0) * time)
    force = [0.0]
    for way in np.diff(x):
        if law == "Dahl":
            end = math.copysign(limit, way)
            force.append(end + (force[-1] - end) * math.exp(-sigma * abs(way) / limit))
        else:
            force.append(min(limit, max(-limit, force[-1] + sigma * way)))
    scatter = random.standard_normal(700)
    if noise == "filtered":
        scatter = lfilter(*butter(2, random.uniform(0.25, 0.9)), scatter)
    scatter = scatter[200:]
    if noise == "hum":
        line = np.sin(2.0 * np.pi * 50.0 * 0.61 * time + random.uniform(0.0, 6.0))
        scatter = line + random.uniform(0.1, 0.5) * scatter
    size = limit * 10.0 ** random.uniform(-2.7, -1.5)
    data = {"time": time, "position": x, "F_t": np.array(force) + size * scatter / np.std(scatter)}
    return data, limit


@pytest.mark.parametrize("noise", ["white", "filtered", "hum"])
def test_noise_is_no_wrong_law_and_a_wrong_law_is_no_noise(noise: str, fmu_path: Path) -> None:
    """Dahl's loops fitted by Dahl's law, and ElasticPlastic's."""
    random = np.random.default_rng(len(noise))
    for law in ("Dahl", "ElasticPlastic"):
        for _ in range(RIGS):
            data, limit = loop(random, law, noise)
            found = fc.identify(data, FIT, start=DAHL, fmu=fmu_path)
            assert len(found.misfits) == (law != "Dahl"), found.misfits
            if law == "Dahl":
                assert found.values["F_C"] == pytest.approx(limit, rel=0.02)
                assert "would not show a wrong gain of the force, a wrong gain of the position" in str(found)
            else:
                assert " % of the friction), is " in found.misfits[0]
                assert any("friction.model = ElasticPlastic" in text for text in found.remedies)
