"""What to set for a scene and an accuracy, and how to couple the contact to a mass."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from fmpy.util import read_csv

from frictioncontact.advice.answer import PHASES, Advice, advise
from frictioncontact.advice.question import OUTPUTS, scene_values
from frictioncontact.advice.stuck_mass import INSIDE, MASTERS
from frictioncontact.command import add_fmu, add_set, command_line, progress_bar, shown
from frictioncontact.fmu import FrictionFmu, Value, opened

DESCRIPTION = """\
Says what to set for a scene so that F_t and F_t_mean are within an accuracy of F_C and of the mean friction:
the default at a tolerance, or Coulomb friction where a bound shows that it is close enough. It then holds
what it says against the FMU at its tightest tolerance, from rest and settled, from several phases.

  %(prog)s --accuracy 1e-3 --set vibration.V_1=1.44 --set vibration.a_d=1.1e-6
  %(prog)s --accuracy 1e-2 --step 1e-3 --output-of F_t_mean --set vibration.V_1=1.44
  %(prog)s --inputs drive.csv --linear --set contact.stiffnessScale=1e-6

With --mass it says how to couple the contact to a mass while it sticks: the smallest damping friction.sigma_1
that keeps the master's exchange stable at the communication step, and the largest step.

  %(prog)s --mass 1 --step 1e-4 --set contact.model=Constant --set contact.sigma=1e6"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("frictioncontact advise", DESCRIPTION)
    add_set(parser, "of the scene")
    parser.add_argument("--accuracy", type=float, default=1e-3, help="largest error over F_C (1e-3)")
    parser.add_argument("--step", type=float, help="communication step, s (a vibration period)")
    parser.add_argument(
        "--mass", type=float, help="mass that moves with the contact, kg: advise on the coupling"
    )
    parser.add_argument(
        "--master", choices=(*MASTERS, INSIDE), default=MASTERS[0], metavar="NAME",
        help=f"how the master exchanges values: {' or '.join(map(repr, MASTERS))} ({MASTERS[0]}), or inside "
        "if the FMU has the mass (body.m)",
    )  # fmt: skip
    parser.add_argument("--output-of", choices=OUTPUTS, default="both", help="which output must be accurate")
    parser.add_argument(
        "--inputs", type=Path, help="CSV with time, in even steps, and any of V, d, E, load, or position"
    )
    parser.add_argument("--linear", action="store_true", help="inputs move linearly between their samples")
    parser.add_argument("--quick", action="store_true", help="grade from two phases instead of five")
    add_fmu(parser)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    fmu = opened(options.fmu)
    known = scene_values(fmu, fmu.known.assigned(options.set))
    with progress_bar() as progress:
        progress.add_task("Grading", total=None)
        found = advise(
            known,
            accuracy=options.accuracy,
            step=options.step,
            output=options.output_of,
            inputs=options.inputs,
            linear=options.linear,
            phases=PHASES[:2] if options.quick else PHASES,
            mass=options.mass,
            master=options.master,
            fmu=options.fmu,
        )
    print(found, command_for(fmu, found, options.inputs), sep="\n\n")


def command_for(fmu: FrictionFmu, found: Advice, path: Path | None) -> str:
    """What runs the scene with its inputs as graded: fmpy holds them, simulate moves them from time 0 on."""
    asked, values = found.asked, start_values(fmu, found.start_values)
    if np.isnan(found.error):  # of a mass
        return values
    fmpy = f"fmpy simulate {shown(fmu.path)} --output-interval {asked.step:.10g}"
    if path is None or asked.table is None:
        return f"{fmpy} {values}".rstrip()
    stop = f"{asked.table.time[-1]:.10g}"
    if asked.linear and asked.start == 0.0:
        settings = " ".join(f"--set {name}={value}" for name, value in found.start_values.items())
        return f"frictioncontact simulate --inputs {path} --stop {stop} --step {asked.step:.10g} {settings}"
    if asked.linear or not fmpy_reads(path, {"time": asked.table.time, **asked.table.values}):
        return f"Neither fmpy nor simulate runs these inputs as they were graded: {values}"
    return f"{fmpy} --start-time {asked.start:.10g} --stop-time {stop} --input-file {path} {values}"


def fmpy_reads(path: Path, inputs: Mapping[str, np.ndarray]) -> bool:
    """Whether FMPy makes the same numbers of the file, under the same names."""
    try:
        table = read_csv(path)
        return table.dtype.names[0] == "time" and all(np.array_equal(table[n], inputs[n]) for n in inputs)
    except (ValueError, IndexError, TypeError):
        return False


def start_values(fmu: FrictionFmu, values: Mapping[str, Value]) -> str:
    """Values as fmpy's command takes them: of an enumeration the number."""
    codes = {name: fmu.known.items[name].get(str(value), value) for name, value in values.items()}
    return " ".join(
        ["--start-values" if codes else "", *(f"{name} {code:.10g}" for name, code in codes.items())]
    )
