"""Writes friction-record.csv.gz and hysteresis.csv from the record that J. Christopherson published.

    python data/measurements/make_record.py test_data_2.txt

test_data_2.txt is examples/test_data_2.txt of https://github.com/jchristopherson/FrictionModels.jl at commit
19de236062631413961fea6da5d1a0b4da97e205 (MIT, LICENSE-FrictionModels.txt): time [s], normal force [uN],
position [mm], friction [uN] with the sign of the force on the sliding body, 200 samples a second. Here the
forces are in N, the position in m from where it stands first, and friction is positive where it resists
positive velocity. No sample is averaged or moved:

    friction-record.csv.gz   every fourth sample, and every sample from 209.4 s to 212 s, where the load falls
    hysteresis.csv           every fourth sample from 30 s to 60 s, the position from where it stands first
"""

from __future__ import annotations

import gzip
import hashlib
import sys
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parent
SHA256 = "e0abf58da8288eebe180a8fe191f1f223a5e1c43025e37c3db7cfb03ce9488a5"
UNLOADING = (209.4, 212.0)  # s
PIECE = (30.0, 60.0)  # s
HEADER = "time [s],load [N],position [m],F_t [N]\n"


def rows(samples: np.ndarray, position: str) -> str:
    """The lines of a table of time [s], load [N], position [m] and friction [N]."""
    return HEADER + "".join(f"{t:.3f},{load:.4f},{x:{position}},{F:.4f}\n" for t, load, x, F in samples)


def main(source: Path) -> None:
    content = source.read_bytes()
    if hashlib.sha256(content).hexdigest() != SHA256:
        raise SystemExit(f"error: {source} is not the published record: its SHA-256 is not {SHA256}")
    time, load, position, friction = np.loadtxt(content.decode().splitlines(), skiprows=1, unpack=True)
    samples = np.column_stack([time, 1e-6 * load, 1e-3 * (position - position[0]), -1e-6 * friction])

    kept = np.arange(len(time)) % 4 == 0
    kept |= (time >= UNLOADING[0]) & (time <= UNLOADING[1])
    text = rows(samples[kept], ".7f")
    (FOLDER / "friction-record.csv.gz").write_bytes(gzip.compress(text.encode(), mtime=0))

    piece = samples[(time >= PIECE[0]) & (time < PIECE[1])][::4]
    piece[:, 2] -= piece[0, 2]
    (FOLDER / "hysteresis.csv").write_text(rows(piece, ".7e"), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
