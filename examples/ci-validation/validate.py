"""Holds results of FrictionContact.fmu, run by fmpy, against bands.csv; exit status 1 if one leaves its band.

Made to be copied: it needs fmpy, matplotlib for the picture, and a CSV file of bands of your own.
"""

from __future__ import annotations

import argparse
import csv
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException

PERIODS = 1000  # brought to the periodic state; the results are those of the last period
COLUMNS = ["scenario", "start values", "quantity", "low", "high", "reason"]


@dataclass(frozen=True)
class Band:
    scenario: str
    start_values: tuple[tuple[str, str], ...]
    quantity: str
    low: float
    high: float
    reason: str


def read_bands(path: Path) -> list[Band]:
    """SystemExit that names row and column if the file is not as it should be."""
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file, strict=True)
        if reader.fieldnames != COLUMNS:
            sys.exit(f"error: {path}: row 1: must be {','.join(COLUMNS)}")
        return [read_band(row, f"{path}: row {number}") for number, row in enumerate(reader, 2)]


def read_band(row: dict[str, str], where: str) -> Band:
    if None in row or None in row.values():
        sys.exit(f"error: {where}: must have {len(COLUMNS)} cells")
    start_values = []
    for word in row["start values"].split():
        name, equals, value = word.partition("=")
        if not equals or not value:
            sys.exit(f"error: {where}, column start values: {word!r} is not of the form NAME=VALUE")
        start_values.append((name, value))
    limits = []
    for column in ("low", "high"):
        try:
            limits.append(float(row[column]))
        except ValueError:
            sys.exit(f"error: {where}, column {column}: {row[column]!r} is not a number")
    return Band(row["scenario"], tuple(start_values), row["quantity"], *limits, row["reason"])


refusals: list[str] = []


def log(environment: int, instance: bytes, status: int, category: bytes, message: bytes) -> None:
    """Keeps errors only: steps of a whole period would be warned about, and F_t_mean is what is read."""
    if status >= 3:
        refusals.append(message.decode())


def simulate(fmu: Path, bands: list[Band], overrides: dict[str, str]) -> list[float]:
    """The value of each band's quantity at the end of its scenario; each scenario is run once."""
    unzipped = extract(str(fmu))
    description = read_model_description(unzipped)
    known = {variable.name for variable in description.modelVariables}
    quantities = sorted({band.quantity for band in bands})
    named = {name for band in bands for name, _ in band.start_values} | {*quantities, *overrides}
    if unknown := sorted(named - known):
        sys.exit(f"error: {', '.join(unknown)}: no variable of {fmu.name}")
    runs: dict[tuple[tuple[str, str], ...], object] = {}
    values = []
    for band in bands:
        if band.start_values not in runs:
            start = {**dict(band.start_values), **overrides}
            period = 1.0 / float(start.get("vibration.f", 20e3))
            runs[band.start_values] = simulate_fmu(
                unzipped,
                model_description=description,
                stop_time=PERIODS * period,
                output_interval=period,
                start_values=start,
                output=quantities,
                logger=log,
            )
        values.append(float(runs[band.start_values][band.quantity][-1]))
    return values


def draw(bands: list[Band], values: list[float], path: Path) -> None:
    """Each value in its band; bands are drawn as wide as each other."""
    figure, axes = plt.subplots(figsize=(5.2, 0.45 * len(bands) + 1.0), layout="constrained")
    for line, (band, value) in enumerate(zip(bands, values, strict=True)):
        place = (value - band.low) / (band.high - band.low)
        inside = band.low <= value <= band.high
        axes.barh(line, 1.0, color="#d0d0d0", height=0.5)
        axes.plot(
            min(max(place, -0.25), 1.25),
            line,
            "o" if inside else "X",
            ms=8,
            color="#0072b2" if inside else "#b2182b",
        )
        axes.text(1.32, line, f"{value:.7g}", va="center", color="#222222" if inside else "#b2182b")
    axes.set_yticks(range(len(bands)), [f"{band.scenario}: {band.quantity}" for band in bands])
    axes.set_xticks([0, 1], ["low", "high"])
    axes.set_xlim(-0.3, 1.65)
    axes.invert_yaxis()
    axes.spines[["top", "right", "left", "bottom"]].set_visible(False)
    axes.set_title("Results in their bands (SI units)", loc="left", fontsize=10.5, fontweight="bold")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=160)


def main() -> None:
    root = Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(prog="examples/ci-validation/run", description=__doc__)
    parser.add_argument("--fmu", type=Path, default=root / "build" / "FrictionContact.fmu")
    parser.add_argument("--bands", type=Path, default=Path(__file__).with_name("bands.csv"))
    parser.add_argument("--start", action="append", default=[], metavar="NAME=VALUE", help="in all scenarios")
    parser.add_argument("--picture", type=Path, default=root / "build" / "examples" / "ci-validation.png")
    options = parser.parse_args()
    try:
        bands = read_bands(options.bands)
        values = simulate(options.fmu, bands, dict(word.split("=", 1) for word in options.start))
        draw(bands, values, options.picture)
    except FMICallException as error:
        sys.exit(f"error: the FMU refused a call: {refusals[-1] if refusals else error}")
    except OSError as error:
        sys.exit(f"error: {error.filename}: {error.strerror or error}")
    left = 0
    for band, value in zip(bands, values, strict=True):
        inside = band.low <= value <= band.high
        left += not inside
        print(
            f"{'ok  ' if inside else 'LEFT'} {band.scenario}: {band.quantity} = {value:.9g}, "
            f"band {band.low:.9g} .. {band.high:.9g} ({band.reason})"
        )
    print(f"{len(bands) - left} of {len(bands)} results in their bands")
    sys.exit(bool(left))


if __name__ == "__main__":
    main()
