"""Writes data/gaussian_heights.csv with the package ContactMechanics, which the project itself does not need.

pip install ContactMechanics==1.8.3
python tests/data/make_gaussian_heights.py
"""

from __future__ import annotations

import csv
from importlib.metadata import version

import numpy as np

from tools.project import ROOT

PATH = ROOT / "data" / "gaussian_heights.csv"


def main() -> None:
    from ContactMechanics.ReferenceSolutions.GreenwoodTripp import Fn

    with PATH.open("w", newline="", encoding="utf-8") as file:
        package = f"ContactMechanics {version('ContactMechanics')}"
        file.write(f"# F_n(h) of a normal height density, by GreenwoodTripp.Fn of {package}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["h", "F_0", "F_1", "F_1.5"])
        for h in np.arange(0.0, 4.01, 0.25):
            writer.writerow([float(h), *(repr(float(Fn(float(h), n))) for n in (0.0, 1.0, 1.5))])


if __name__ == "__main__":
    main()
