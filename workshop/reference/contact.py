"""Real contact area and stiffness from the formulas (Eq. 3, 12-14, 20-22, corrected), at 40 digits."""

from dataclasses import dataclass
from typing import Any

from frictioncontact.parameters import Surfaces
from workshop.reference.arithmetic import MP


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


def hardness(contact: Contact) -> Any:
    """p_m [Pa], the mean contact pressure at which a contact yields, Eq. 12."""
    return hardness_coefficient(contact) * (1 - MP.mpf(contact.nu) ** 2) * MP.mpf(contact.Y)


def critical_interference(contact: Contact, E: Any) -> Any:
    """omega_c [m], Eq. 13."""
    return (MP.pi * hardness(contact) / (2 * MP.mpf(E))) ** 2 * MP.mpf(contact.R)


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


def _dimensionless_interference(contact: Contact, E: Any) -> Any:
    """x = lambda omega_c / R_q."""
    return MP.mpf(contact.lambda_) * critical_interference(contact, E) / MP.mpf(contact.R_q)


def _asperities_reaching(contact: Contact, d: Any) -> Any:
    """N(d) = eta A_n c e^(-lambda d / R_q)."""
    reach = MP.exp(-MP.mpf(contact.lambda_) * MP.mpf(d) / MP.mpf(contact.R_q))
    return MP.mpf(contact.eta) * MP.mpf(contact.A_n) * MP.mpf(contact.c) * reach


def normal_force(contact: Contact, d: Any, E: Any) -> Any:
    """F_n [N], Eq. 9 (corrected) and Eq. 16 over the heights: elastic up to omega_c, plastic beyond."""
    R, R_q, lam = MP.mpf(contact.R), MP.mpf(contact.R_q), MP.mpf(contact.lambda_)
    x = _dimensionless_interference(contact, E)
    elastic = MP.mpf(4) / 3 * MP.mpf(E) * MP.sqrt(R * R_q**3 / lam**5) * MP.gammainc(MP.mpf("2.5"), 0, x)
    plastic = MP.pi * R * R_q * hardness(contact) * (2 + x) * MP.exp(-x) / lam**2
    return _asperities_reaching(contact, d) * (elastic + plastic)


def mindlin_stiffness(contact: Contact, d: Any, E: Any) -> Any:
    """The sum of each contact's tangential stiffness [N/m], without stiffnessScale."""
    R, R_q, lam, nu = (MP.mpf(v) for v in (contact.R, contact.R_q, contact.lambda_, contact.nu))
    x = _dimensionless_interference(contact, E)
    s = MP.mpf("1.5")
    elastic = MP.gammainc(s, 0, x) / lam**s
    plastic = (2 / lam) ** s * MP.exp(-x / 2) * MP.gammainc(s, x / 2) / 2
    tangential = 2 * (1 - nu) / (2 - nu)
    return (
        _asperities_reaching(contact, d) * 2 * MP.mpf(E) * tangential * MP.sqrt(R * R_q) * (elastic + plastic)
    )


def stiffness(contact: Contact, d: Any, E: Any) -> Any:
    """sigma [N/m], Eq. 3 or Mindlin's."""
    if contact.model == "Constant":
        return MP.mpf(contact.sigma)
    if contact.model == "Mindlin":
        return MP.mpf(contact.stiffnessScale) * mindlin_stiffness(contact, d, E)
    return MP.mpf(contact.stiffnessScale) * MP.mpf(E) * area(contact, d, E) ** 2 / MP.mpf(d) ** 3
