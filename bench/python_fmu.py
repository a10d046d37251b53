"""The same equation as a FMU written in Python exports it: PythonFMU around scipy's solve_ivp (LSODA).

pythonfmu build -f bench/python_fmu.py
"""

from __future__ import annotations

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from scipy.integrate import solve_ivp

PARAMETERS = ("F_C", "sigma", "d_ref", "decay", "f", "V_1", "a_d", "phase_d", "tolerance")


class PythonFriction(Fmi2Slave):
    author = "The FrictionContact authors"
    description = "Dahl friction (Eq. 1, 2), for comparison"

    def __init__(self, **settings: object) -> None:
        super().__init__(**settings)
        self.V, self.d = 0.005, 14e-6
        self.F_C, self.sigma, self.d_ref, self.decay = 55.0, 2.5e6, 14e-6, 0.0
        self.f, self.V_1, self.a_d, self.phase_d = 20e3, 0.0, 0.0, 0.0
        self.tolerance = 1e-6
        self.F_t = self.F_t_mean = self.evaluations = 0.0
        self.delta = 0.0
        for name in ("V", "d"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in PARAMETERS:
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable)
            )
        for name in ("F_t", "F_t_mean", "evaluations"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def stiffness(self, t: float) -> float:
        if self.decay == 0.0:
            return self.sigma
        d = self.d + self.a_d * math.cos(2 * math.pi * self.f * t + self.phase_d)
        return self.sigma * (self.d_ref / d) ** 3 * math.exp(-2 * self.decay * (d - self.d_ref))

    def slope(self, t: float, y: list[float]) -> tuple[float, float]:
        """Of the deflection over F_C / sigma, and of the time integral of F_t over F_C."""
        V = self.V + self.V_1 * math.cos(2 * math.pi * self.f * t)
        ratio = self.stiffness(t) / self.sigma * y[0]
        return (V - abs(V) * ratio) * self.sigma / self.F_C, ratio

    def do_step(self, current_time: float, step_size: float) -> bool:
        end = current_time + step_size
        result = solve_ivp(
            self.slope,
            (current_time, end),
            (self.delta, 0.0),
            method="LSODA",
            t_eval=(end,),
            rtol=self.tolerance,
            atol=(self.tolerance, self.tolerance * step_size),
        )
        self.evaluations += result.nfev
        if not result.success:
            return False
        self.delta = float(result.y[0, -1])
        self.F_t = self.F_C * self.stiffness(end) / self.sigma * self.delta
        self.F_t_mean = self.F_C * float(result.y[1, -1]) / step_size
        return True
