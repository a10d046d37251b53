"""What F_n and sigma are over e^(-lambda d / R_q), as functions of E, for numbers, arrays and jets.

gamma(s, x) = x^s e^-x sum_k x^k / (s (s+1) .. (s+k)): every term is positive, nothing cancels.
"""

from typing import Any

import numpy as np

from workshop.reference.arithmetic import MP, Arithmetic
from workshop.reference.contact import Contact, critical_interference, hardness, roughness


class ContactCoefficients:
    """E: where it starts [Pa]; it stays within a factor of ten."""

    def __init__(self, contact: Contact, E: float, arithmetic: Arithmetic) -> None:
        real = arithmetic.real
        self.arithmetic = arithmetic
        lam, R_q, R = MP.mpf(contact.lambda_), MP.mpf(contact.R_q), MP.mpf(contact.R)
        density = MP.mpf(contact.eta) * MP.mpf(contact.A_n) * MP.mpf(contact.c)
        scale, nu = MP.mpf(contact.stiffnessScale), MP.mpf(contact.nu)
        # x = lambda omega_c / R_q goes with 1 / E^2
        x_E2 = lam * critical_interference(contact, 1) / R_q
        self.root_x_E = real(MP.sqrt(x_E2))
        terms = _terms(110 * x_E2 / MP.mpf(E) ** 2, arithmetic)
        # of each term of the series to the one before, over x
        self.ratios = {n: [real(MP.mpf(2) / (n + 2 * k)) for k in range(terms)] for n in (3, 5)}
        self.elastic = real(density * MP.mpf(4) / 3 * MP.sqrt(R * R_q**3 / lam**5))
        self.plastic = real(density * MP.pi * R * R_q * hardness(contact) / lam**2)
        tangential = 2 * (1 - nu) / (2 - nu)
        self.mindlin_front = real(scale * density * 2 * tangential * MP.sqrt(R * R_q / lam**3))
        self.half_root_pi, self.root_2 = real(MP.sqrt(MP.pi) / 2), real(MP.sqrt(2))
        front = MP.mpf(contact.c) * MP.pi * roughness(contact) * MP.mpf(contact.A_n) / lam**2
        self.area_squared = real(scale * front**2)

    def normal_force(self, E: Any) -> Any:
        """F_n e^(lambda d / R_q) [N], Eq. 9 and 16 summed."""
        root_x = self.root_x_E / E
        x = root_x * root_x
        elastic = self.elastic * E * self._lower_gamma(5, root_x)
        return elastic + self.plastic * (2 + x) * self.arithmetic.exp(-x)

    def mindlin(self, E: Any) -> Any:
        """sigma e^(lambda d / R_q) [N/m]: the sum of each contact's tangential stiffness."""
        root_x = self.root_x_E / E
        half = root_x / self.root_2
        upper = self.half_root_pi - self._lower_gamma(3, half)
        plastic = self.root_2 * self.arithmetic.exp(-(half * half)) * upper
        return self.mindlin_front * E * (self._lower_gamma(3, root_x) + plastic)

    def asperities(self, E: Any) -> Any:
        """sigma d^3 e^(2 lambda d / R_q) [N m2], Eq. 3 with Eq. 20-22."""
        root_x = self.root_x_E / E
        bracket = 1 + self.arithmetic.exp(-(root_x * root_x))
        return self.area_squared * E * bracket * bracket

    def _lower_gamma(self, twice_s: int, root_x: Any) -> Any:
        """gamma(s, x) for s = twice_s / 2."""
        x = root_x * root_x
        first, *rest = self.ratios[twice_s]
        term = total = first + 0 * x
        for ratio in rest:
            term = term * x * ratio
            total = total + term
        power = root_x
        for _ in range(twice_s - 1):
            power = power * root_x
        return power * self.arithmetic.exp(-x) * total


def _terms(x: Any, arithmetic: Arithmetic) -> int:
    """Terms of the series up to x that reach all digits."""
    digits = 24 if arithmetic.dtype is np.longdouble else MP.dps
    n, term = 1, MP.mpf(1)
    while term > MP.mpf(10) ** -digits:
        term *= x / n
        n += 1
    return n + 1
