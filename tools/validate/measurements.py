"""The measurements of data/measurements, as arrays. Sources are in that folder's README."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frictioncontact import resources

FOLDER = resources.data() / "measurements"


def _table(name: str) -> np.ndarray:
    """A file with a header, by the names of its columns."""
    return np.genfromtxt(FOLDER / name, delimiter=",", names=True, dtype=None, encoding="utf-8")


@dataclass(frozen=True)
class Sliding:
    """Mean friction of sliding, without and with a longitudinal vibration (Luo 2024)."""

    V: np.ndarray  # m/s; without the row at rest
    without: np.ndarray  # N
    vibrated: np.ndarray  # N
    static_without: float  # N, largest static friction

    f: float = 26e3  # Hz
    amplitude: float = 0.35e-6  # m

    @property
    def V_1(self) -> float:
        """Amplitude of the velocity [m/s]."""
        return 2.0 * np.pi * self.f * self.amplitude


def sliding(lubrication: str) -> Sliding:
    """The rows of luo2024.csv, "dry" or "oil"."""
    rows = _table("luo2024.csv")
    rows = rows[rows["lubrication"] == lubrication]
    V, without, vibrated = (rows[name] for name in ("V_m_per_s", "F_without_N", "F_with_N"))
    rest = V == 0.0
    return Sliding(V[~rest], without[~rest], vibrated[~rest], float(without[rest][0]))


@dataclass(frozen=True)
class Record:
    """Friction along a prescribed path under a prescribed load (friction-record.csv.gz), or a part of it."""

    time: np.ndarray  # s
    load: np.ndarray  # N
    position: np.ndarray  # m
    friction: np.ndarray  # N, positive where it resists positive velocity

    def between(self, first: float, last: float) -> Record:
        """The samples from first to last [s]."""
        kept = (self.time >= first) & (self.time <= last)
        return Record(self.time[kept], self.load[kept], self.position[kept], self.friction[kept])


def record() -> Record:
    """The whole record."""
    return Record(*np.loadtxt(FOLDER / "friction-record.csv.gz", delimiter=",", skiprows=1, unpack=True))


@dataclass(frozen=True)
class NormalVibration:
    """Reduction of friction by a vibration normal to the surface (Dong 2015)."""

    V: np.ndarray  # m/s
    reduction: np.ndarray  # of the friction without vibration

    f: float = 22e3  # Hz
    between: float = 40.6e-3  # m/s, measured as well; the abstract does not print its reduction


def normal_vibration() -> NormalVibration:
    rows = _table("dong2015.csv")
    return NormalVibration(rows["V_m_per_s"], rows["reduction"])


def rms(error: np.ndarray) -> float:
    return float(np.sqrt(np.mean(error**2)))
