"""`friction_law`: the settled forces as functions of the inputs, for machines slower than the vibration."""

from __future__ import annotations

import argparse
import math
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, overload

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from frictioncontact import command as shared
from frictioncontact.errors import UserError
from frictioncontact.files import write_whole
from frictioncontact.fmu import FrictionFmu, Value, opened
from frictioncontact.plausibility import warn_of
from frictioncontact.values import assignments, numbers_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORCE, TRANSVERSE = "F_t_settled", "F_y_settled"
SCALES = ("vibration.V_1", "vibration.V_2", "friction.V_S")  # of velocities
LEAST, GROWTH, FARTHEST = (
    0.01,
    1.1,
    1e4,
)  # amplitudes that are tried: first and last over V, each over the last
NEAR = 1e-12  # of their scale: a change of the force within it is a jump


class FrictionLaw:
    """The friction force [N] as a function of the inputs: its mean over a period of the vibration, settled.

    `start` holds the scene. `friction_law` makes it. Use it in one thread only.
    """

    def __init__(self, start: Mapping[str, Value] | None, fmu: FrictionFmu) -> None:
        self._fmu = fmu
        self.start = self._fmu.known.values(start, "scene")
        self._session = self._fmu.session(self.start)
        weakref.finalize(self, self._session.close)
        self._base = {name: self._session.get(name) for name in self._fmu.known.inputs}
        self._seen: set[str] = set()  # inputs that were set
        warn_of(self._fmu.known, self.start, self._session.warnings)

    def __repr__(self) -> str:
        return f"<friction law of {self.start}>"

    def __reduce__(self) -> tuple[Callable[..., FrictionLaw], tuple[dict[str, Value], FrictionFmu]]:
        return FrictionLaw, (self.start, self._fmu)

    @overload
    def __call__(self, V: float, **inputs: float) -> float: ...

    @overload
    def __call__(self, V: npt.ArrayLike, **inputs: npt.ArrayLike) -> float | np.ndarray: ...

    def __call__(self, V: npt.ArrayLike, **inputs: npt.ArrayLike) -> float | np.ndarray:
        """The force at velocities.

        V         velocity, m/s: a number, or an array of any shape
        inputs    V_y [m/s], d [m], load [N], E [Pa] by name, of shapes that broadcast with V; the scene's if
                  not given
        returns   force, N: a float, or an array of the common shape
        raises    UserError: a name or a value is wrong; FrictionError: the FMU refuses it
        """
        return self._at(V, inputs, lambda: self._session.get(FORCE))

    def transverse(self, V: npt.ArrayLike, **inputs: npt.ArrayLike) -> float | np.ndarray:
        """The force transverse to V, F_y_settled [N]; arguments as in a call."""
        return self._at(V, inputs, lambda: self._session.get(TRANSVERSE))

    @overload
    def derivative(self, V: float, by: str = "V", *, of: str = FORCE, **inputs: float) -> float: ...

    @overload
    def derivative(
        self, V: npt.ArrayLike, by: str = "V", *, of: str = FORCE, **inputs: npt.ArrayLike
    ) -> float | np.ndarray: ...

    def derivative(
        self, V: npt.ArrayLike, by: str = "V", *, of: str = FORCE, **inputs: npt.ArrayLike
    ) -> float | np.ndarray:
        """The derivative of a force by one of the inputs: at a kink that of one side, at a jump nan.

        V         velocity, m/s: a number, or an array of any shape
        by        the input: V, V_y, d, load or E
        of        the force: "F_t_settled", or "F_y_settled" transverse to V
        inputs    as in a call
        returns   N over the input's unit: a float, or an array of the common shape
        raises    UserError, FrictionError: as in a call
        """
        self._fmu.known.find(by, "by", ("input",))
        if of not in (FORCE, TRANSVERSE):
            raise UserError(f"of {of}: must be {FORCE} or {TRANSVERSE}")
        return self._at(V, inputs, lambda: math.nan if self._jumps(by) else self._session.slope(of, by))

    def _jumps(self, by: str) -> bool:
        """Whether the forces jump here over a velocity, as Coulomb's at V = 0: by 1 % of those far away."""
        if by not in ("V", "V_y"):
            return False
        here, scale = self._session.get(by), max(self._session.read(SCALES))
        forces = []
        for place in (here - NEAR * scale, here + NEAR * scale, here + 10.0 * scale):
            self._session.set(by, place)
            forces.append(self._session.read((FORCE, TRANSVERSE)))
        self._session.set(by, here)
        below, above, far = forces
        return bool(np.linalg.norm(above - below) > 0.01 * np.linalg.norm(far))

    def _at(
        self, V: npt.ArrayLike, inputs: Mapping[str, npt.ArrayLike], read: Callable[[], float]
    ) -> float | np.ndarray:
        given = {}
        for name, value in {"V": V, **inputs}.items():
            self._fmu.known.find(name, "inputs", ("input",))
            given[name] = numbers_of(value, name)
        if not given.keys() <= self._seen:
            warn_of(self._fmu.known, self.start | given)
        try:
            arrays = dict(zip(given, np.broadcast_arrays(*given.values()), strict=True))
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in given.items())
            raise UserError(f"the shapes do not go together: {shapes}") from None
        points = self._points(arrays)
        found = np.array([read() for _ in points]).reshape(arrays["V"].shape)
        return found if found.ndim else float(found)

    def _points(self, arrays: Mapping[str, np.ndarray]) -> Iterator[None]:
        """Sets the inputs of one point after the other."""
        for name in self._seen - arrays.keys():
            self._session.set(name, self._base[name])
        self._seen |= arrays.keys()
        for values in zip(*(array.flat for array in arrays.values()), strict=True):
            for name, value in zip(arrays, values, strict=True):
                self._session.set(name, float(value))
            yield

    def amplitude_for(self, reduction: float, V: float, **inputs: float) -> float:
        """The least vibration.V_1 [m/s] that lowers the force by a part of the force without vibration.V_1.

        reduction  from 0 to 1: 0.6 leaves 40 % of the force
        V          velocity, m/s
        inputs     as in a call, numbers
        raises     UserError: no amplitude up to FARTHEST times the velocity does; and as in a call
        """
        if not 0.0 < reduction < 1.0:
            raise UserError(f"reduction = {reduction}: must be between 0 and 1")
        name, before = SCALES[0], self._session.get(SCALES[0])

        def left(amplitude: float) -> float:
            self._session.set(name, float(amplitude))
            return float(self(V, **inputs))

        try:
            aim, low, high = (1.0 - reduction) * left(0.0), 0.0, LEAST * abs(V)
            while abs(left(high)) > abs(aim):
                low, high = high, GROWTH * high
                if not high <= FARTHEST * abs(V):
                    raise UserError(f"no vibration.V_1 up to {low:.3g} m/s lowers the force by {reduction:g}")
            return float(brentq(lambda amplitude: left(amplitude) - aim, low, high, rtol=1e-9))
        finally:
            self._session.set(name, before)

    def plot(self, V: npt.ArrayLike | None = None, **inputs: float) -> Figure:
        """A figure of the force and of its derivative against the velocity. Needs frictioncontact[plot].

        V         velocities, m/s; if not given from 0 to 1.5 times the vibration's amplitude, or 10 times V_S
        inputs    as in a call, numbers
        returns   a figure of matplotlib, with `savefig`
        """
        from frictioncontact import style

        if V is None:
            V_1, V_2, V_S = self._session.read(SCALES)
            V = np.linspace(0.0, 1.5 * max(V_1, V_2) or 10.0 * V_S, 201)[1:]
        with style.kept():
            figure, (force, slope) = style.subplots(1, 2, size=(9.0, 3.5))
            force.plot(V, self(V, **inputs))
            slope.plot(V, self.derivative(V, **inputs))
        force.set(xlabel="V [m/s]", ylabel="mean friction [N]", title="F_t_settled")
        slope.set(xlabel="V [m/s]", ylabel="[N s/m]", title="its derivative by V")
        return figure


def friction_law(scene: Mapping[str, Value] | None = None, *, fmu: str | Path | None = None) -> FrictionLaw:
    """The friction law for a machine that is slower than the vibration: F_t_settled as a function.

    scene     name of an input or parameter -> value, SI units; of an enumeration an item or its number
    fmu       another .fmu file of this model
    returns   a `FrictionLaw`: call it with velocities; `transverse`, `derivative`, `plot`
    raises    UserError: a name or a value is wrong; FrictionError: the FMU refuses the scene
    warns     FrictionWarning: of a setting that has no effect; of an unlikely magnitude

        import numpy as np
        import frictioncontact as fc
        law = fc.friction_law({"vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7})
        print(law(0.5), law.derivative(0.5))
        print(law(np.linspace(0.1, 2.0, 5), E=[[44.6e9], [58.6e9]]).shape)
    """
    return FrictionLaw(scene, opened(fmu))


DESCRIPTION = """\
The friction law that a machine sees which is slower than the vibration: the mean force over a period, once
settled, and its derivative by V, at every combination of the values that --vary gives to inputs. With motion
transverse to V the mean transverse force is there, too. All values are in SI units; the headings of a CSV
file are the names alone.

  %(prog)s --set vibration.V_1=1.44 --set contact.stiffnessScale=4.4e-7
  %(prog)s --set vibration.V_1=1.44 --vary V=0.01:2:50:log --vary E=40e9,58e9 --output law.csv
  %(prog)s --set vibration.V_1=1.44 --vary V=0:2:200 --picture law.png"""


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = shared.command_line("frictioncontact law", DESCRIPTION)
    shared.add_set(parser, "of the scene")
    parser.add_argument(
        "--vary", action="append", default=[], metavar="NAME=VALUES",
        help="a,b,c or low:high:count[:log] of an input",
    )  # fmt: skip
    parser.add_argument("--output", type=shared.new_file, metavar="CSV", help="write the table there")
    parser.add_argument(
        "--picture", type=shared.new_file, metavar="PNG", help="draw the law over V there (.png, .svg, .pdf)"
    )
    shared.add_fmu(parser)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    import pandas as pd

    from frictioncontact.sweeps.scenarios import grid

    if options.picture and options.picture.suffix not in (".png", ".svg", ".pdf"):
        raise UserError(f"--picture {options.picture}: must end in .png, .svg or .pdf")
    known = opened(options.fmu).known
    scene = known.assigned(options.set)
    law = friction_law(scene, fmu=options.fmu)
    vary = assignments(options.vary, "--vary")
    for name in vary:
        known.find(name, "--vary", ("input",))
    if "V" in scene and "V" not in vary:
        vary["V"] = str(scene["V"])
    elif "V" not in vary:
        amplitude = max(float(law.start.get(f"vibration.{name}", 0.0)) for name in ("V_1", "V_2"))
        vary["V"] = f"0:{1.5 * amplitude or 0.1}:16"
    made = grid(known, vary)
    inputs = made.rows(0, made.count)
    V = inputs.pop("V")
    table = pd.DataFrame({"V": V, **inputs, FORCE: law(V, **inputs), "d/dV": law.derivative(V, **inputs)})
    if {"V_y", "vibration.V_2", "delta_y_0"} & {*inputs, *law.start}:
        table[TRANSVERSE] = law.transverse(V, **inputs)
    if options.output:
        write_whole(options.output, table.to_csv(index=False))
    else:
        shared.print_frame(table, known, scene, **{"d/dV": "N s/m"})
    if options.picture and shared.can_draw():
        from frictioncontact import style

        for name, values in inputs.items():
            if len(np.unique(values)) > 1:
                raise UserError(f"--picture draws the law over V alone: give one value of {name}")
        held = {name: float(values[0]) for name, values in inputs.items()}
        style.save(law.plot(np.unique(V), **held), options.picture)
    shared.say_written([path for path in (options.output, options.picture) if path])
