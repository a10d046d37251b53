"""Table 1 and Table 2 of the paper: the one place where their numbers stand in Python.

A scene is given to the FMU as a dictionary of start values under the names of its variables.
"""

import math
from dataclasses import dataclass

# Table 1
E_1 = 71.3e9  # Pa    softer body (aluminium)
E_2 = 200e9  # Pa    harder body (steel)
NU_1 = 0.33
NU_2 = 0.29
E_1_REDUCTION = 0.30  # of E_1 under ultrasound
COULOMB_FORCE = 55.0  # N
FREQUENCY = 20e3  # Hz
SEPARATION = 14e-6  # m
VELOCITY_PRINTED = 0.005  # m/s
VELOCITY_IDENTIFIED = 0.5  # m/s, the velocity of Fig. 3-4
PERIOD = 1.0 / FREQUENCY  # s

STIFFNESS_PRINTED = 5.743065402e12  # N/m at 14 um, of Table 1


def combined_modulus(E_1: float = E_1, nu_1: float = NU_1, E_2: float = E_2, nu_2: float = NU_2) -> float:
    """E [Pa], Eq. 4."""
    return 1.0 / ((1.0 - nu_1**2) / E_1 + (1.0 - nu_2**2) / E_2)


E_FULL = combined_modulus()
E_REDUCED = combined_modulus((1.0 - E_1_REDUCTION) * E_1)


@dataclass(frozen=True)
class Surfaces:
    """Two rough surfaces as one, under the names of the FMU's variables; start values of Table 1."""

    R_q: float = 6e-6  # m
    R: float = 1.7e-6  # m
    eta: float = 47e9  # 1/m2
    A_n: float = 1e-4  # m2
    nu: float = NU_1
    Y: float = 410e6  # Pa
    c: float = 17.0
    lambda_: float = 3.0

    @property
    def beta(self) -> float:
        return self.eta * self.R * self.R_q

    @property
    def yield_pressure(self) -> float:
        """p_m [Pa], Eq. 12 and 14."""
        return (1.234 + 1.256 * self.nu) * (1.0 - self.nu**2) * self.Y

    def critical_interference(self, E: float) -> float:
        """omega_c [m], Eq. 13."""
        return (math.pi * self.yield_pressure / (2.0 * E)) ** 2 * self.R


@dataclass(frozen=True)
class Row:
    """One row of Table 2."""

    number: int
    softened: bool  # E_1 reduced by 30 %
    a_d: float  # m
    V_1: float  # m/s
    paper_force: float  # N
    paper_reduction: float  # percent


TABLE_2 = (
    Row(1, False, 0.0, 0.0, 55.0, 0.0),
    Row(2, True, 1.1e-6, 1.44, 21.0, 62.0),
    Row(3, False, 0.0, 1.44, 27.0, 51.0),
    Row(4, False, 1.1e-6, 0.0, 48.0, 12.0),
    Row(5, True, 0.0, 0.0, 54.0, 1.0),
    Row(6, True, 0.9e-6, 1.15, 28.0, 49.0),
)


@dataclass(frozen=True)
class ParameterSet:
    """What the rows of Table 2 leave open."""

    name: str
    V: float  # m/s
    stiffness: float  # N/m at 14 um and the full modulus
    phase_d: float  # degrees

    @property
    def stiffnessScale(self) -> float:
        return self.stiffness / STIFFNESS_PRINTED


PRINTED = ParameterSet("printed", VELOCITY_PRINTED, STIFFNESS_PRINTED, 0.0)
# Three numbers (V too) adjusted to three informative rows: an identification, not a validation.
IDENTIFIED = ParameterSet("identified", VELOCITY_IDENTIFIED, 2.5366e6, 224.94)


def start_values(row: Row, parameters: ParameterSet = PRINTED) -> dict[str, float]:
    """FMU start values of one row of Table 2."""
    return {
        "V": parameters.V,
        "d": SEPARATION,
        "E": E_REDUCED if row.softened else E_FULL,
        "F_C": COULOMB_FORCE,
        "contact.stiffnessScale": parameters.stiffnessScale,
        "vibration.f": FREQUENCY,
        "vibration.V_1": row.V_1,
        "vibration.a_d": row.a_d,
        "vibration.phase_d": math.radians(parameters.phase_d),
    }
