"""A mass inside the FMU in steps of 1 ms: a pulled mass sticks and slips, a slider creeps by ultrasound."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
from fmpy import simulate_fmu
from fmpy.util import read_csv, write_csv

from examples.systems import parameters, run_fmpy, run_libcosim, write_ssp
from frictioncontact import friction_law, simulate
from frictioncontact.errors import UserError
from tools.bench.mass_inside import ROWS, exact
from tools.build import build_fmu
from tools.project import ROOT

HERE = Path(__file__).resolve().parent
H, SLIDES = 1e-3, 50  # s, and the steps of the slider
PULLED = {  # ElasticPlastic on a contact of constant stiffness: enumerations as numbers
    "body.m": 1.0, "V": 0.0, "F_C": 55.0, "friction.model": 3, "contact.model": 2, "contact.sigma": 6e6
}  # fmt: skip
SIGNALS = (("slider", "body.x"), ("slider", "F_t_mean"))


def pull() -> np.ndarray:
    """Samples of the pull: 80 N at 10 Hz, for 0.1 s."""
    time = H * np.arange(101)
    samples = np.zeros(len(time), [("time", float), ("body.F", float)])
    samples["time"], samples["body.F"] = time, 80.0 * np.sin(2.0 * np.pi * 10.0 * time)
    return samples


def by_package(fmu: Path) -> pd.DataFrame:
    """The pulled mass by the package, which sends the derivative of body.F: it is linear over a step."""
    samples = pull()
    inputs = {name: samples[name] for name in samples.dtype.names}
    return simulate(PULLED, stop=0.1, step=H, inputs=inputs, outputs=["body.v", "F_t_mean"], fmu=fmu)


def by_fmpy(fmu: Path) -> np.ndarray:
    """The same by FMPy, which holds body.F over a step."""
    outputs = ["body.v", "F_t_mean"]
    times = {"stop_time": 0.1, "output_interval": H}
    return simulate_fmu(str(fmu), start_values=PULLED, input=pull(), output=outputs, **times)


def by_command(fmu: Path, folder: Path) -> np.ndarray:
    """The same by the command of FMPy."""
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(folder / "pull.csv", pull())
    starts = [word for name, value in PULLED.items() for word in (name, str(value))]
    command = [sys.executable, "-m", "fmpy", "simulate", str(fmu), "--start-values", *starts]
    command += ["--input-file", folder / "pull.csv", "--output-file", folder / "pulled.csv"]
    command += ["--stop-time", "0.1", "--output-interval", str(H), "--output-variables", "body.v", "F_t"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return read_csv(folder / "pulled.csv")


def error(found: np.ndarray | pd.DataFrame) -> float:
    """The largest error of v over the largest v: against the whole motion by brute force."""
    right = np.concatenate([[0.0], exact(ROWS[0])["v"]])
    return float(np.abs(found["body.v"] - right).max() / np.abs(right).max())


def description() -> str:
    return (HERE / "SystemStructure.ssd").read_text()


def make_ssp(fmu: Path, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    return write_ssp(description(), [fmu], folder / "mass-inside.ssp")


def final(run: dict[tuple[str, str], np.ndarray]) -> tuple[float, float]:
    """The mean of v [m/s] and of the friction [N] over the last step, since both swing with the vibration."""
    x, force = (run[signal] for signal in SIGNALS)
    return float(x[-1] - x[-2]) / H, float(force[-1])


def final_velocity() -> float:
    """v [m/s] at which the mean friction of the slider is the pull."""
    start = {name: value for (_, name), value in parameters(description()).items() if "body" not in name}
    law, speeds = friction_law(start), np.linspace(0.0, 1.44, 300)
    return float(np.interp(15.0, law(speeds), speeds))


def main() -> None:
    parser = argparse.ArgumentParser(prog="examples/mass-inside/run", description=__doc__)
    parser.add_argument(
        "--output", type=Path, default=ROOT / "build" / "examples" / "mass-inside", help="folder"
    )
    options = parser.parse_args()
    try:
        fmu = build_fmu()
        for name, found in (
            ("fc.simulate, linear", by_package(fmu)),
            ("FMPy, held", by_fmpy(fmu)),
            ("fmpy simulate, held", by_command(fmu, options.output)),
        ):
            print(f"pulled mass, {name:20} error of v {100 * error(found):.2g} %")
        ssp = make_ssp(fmu, options.output)
        for name, run in (
            ("libcosim", run_libcosim(ssp, round(1e9 * H), SLIDES, SIGNALS)),
            ("FMPy", run_fmpy(ssp, H, SLIDES, SIGNALS)),
        ):
            v, force = final(run)
            print(f"slider, .ssp in {name:8} mean of v {1e3 * v:.1f} mm/s, mean friction {force:.3f} N")
        print(f"its friction law: {1e3 * final_velocity():.1f} mm/s")
    except (UserError, OSError, subprocess.CalledProcessError) as error_:
        sys.exit(f"error: {error_}")


if __name__ == "__main__":
    main()
