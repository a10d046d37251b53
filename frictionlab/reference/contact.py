"""Real contact area and stiffness from the formulas (Eq. 3, 12-14, 20-22, corrected), at 40 digits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from frictionlab.parameters import Surfaces
from frictionlab.reference.arithmetic import MP


@dataclass(frozen=True)
class Contact:
    """Parameters of the contact, under the names of the FMU's variables contact.*."""

    model: str = "Asperities"
    sigma: float = 2.5e6  # N/m, when model is Constant
    stiffnessScale: float = 1.0
    R_q: float = Surfaces.R_q  # m
    R: float = Surfaces.R  # m
    eta: float = Surfaces.eta  # 1/m2
    A_n: float = Surfaces.A_n  # m2
    nu: float = Surfaces.nu
    Y: float = Surfaces.Y  # Pa
    c: float = Surfaces.c
    # the FMU's contact.lambda
    lambda_: float = Surfaces.lambda_


def combined_modulus(E_1: float, nu_1: float, E_2: float, nu_2: float) -> Any:
    """E [Pa], Eq. 4."""
    return 1 / ((1 - MP.mpf(nu_1) ** 2) / E_1 + (1 - MP.mpf(nu_2) ** 2) / E_2)


def hardness_coefficient(contact: Contact) -> Any:
    """C_v, Eq. 14."""
    return MP.mpf("1.234") + MP.mpf("1.256") * MP.mpf(contact.nu)


def critical_interference(contact: Contact, E: Any) -> Any:
    """omega_c [m], Eq. 12-13."""
    nu, Y, R = MP.mpf(contact.nu), MP.mpf(contact.Y), MP.mpf(contact.R)
    return (MP.pi * hardness_coefficient(contact) * (1 - nu**2) * Y / (2 * MP.mpf(E))) ** 2 * R


def roughness(contact: Contact) -> Any:
    """beta = eta R R_q."""
    return MP.mpf(contact.eta) * MP.mpf(contact.R) * MP.mpf(contact.R_q)


def area(contact: Contact, d: Any, E: Any) -> Any:
    """A_r [m2], Eq. 20-22: the elastic and the plastic part of the integral, summed as they stand."""
    R_q, lam = MP.mpf(contact.R_q), MP.mpf(contact.lambda_)
    x = lam * critical_interference(contact, E) / R_q
    front = MP.mpf(contact.c) * MP.pi * roughness(contact) * MP.mpf(contact.A_n) / lam**2
    elastic = 1 - (1 + x) * MP.exp(-x)
    plastic = (2 + x) * MP.exp(-x)
    return front * (elastic + plastic) * MP.exp(-lam * MP.mpf(d) / R_q)


def stiffness(contact: Contact, d: Any, E: Any) -> Any:
    """sigma [N/m], Eq. 3."""
    if contact.model == "Constant":
        return MP.mpf(contact.sigma)
    return MP.mpf(contact.stiffnessScale) * MP.mpf(E) * area(contact, d, E) ** 2 / MP.mpf(d) ** 3


def gradient(quantity: Any, contact: Contact, d: Any, E: Any) -> tuple[Any, Any]:
    """Partial derivatives of area or stiffness with respect to d and E, by central differences at 40 digits.

    The relative step of 1e-6 with the Richardson correction leaves a relative error of 1e-20 or so.
    """

    def slope(function: Any, x: Any) -> Any:
        h = x * MP.mpf("1e-6")
        wide = (function(x + h) - function(x - h)) / (2 * h)
        narrow = (function(x + h / 2) - function(x - h / 2)) / h
        return (4 * narrow - wide) / 3

    d, E = MP.mpf(d), MP.mpf(E)
    return slope(lambda y: quantity(contact, y, E), d), slope(lambda y: quantity(contact, d, y), E)
