"""The FMU's A_r and sigma against the formulas and the digits of Table 1 (Eq. 3, 4, 12-14, 20-22)."""

from __future__ import annotations

from typing import Any

import pytest

from frictioncontact import parameters as scenarios
from frictioncontact.fmu import FrictionFmu, Session
from workshop.reference import contact as reference_contact
from workshop.reference.arithmetic import MP
from workshop.reference.contact import Contact

E_FULL, E_REDUCED = scenarios.E_FULL, scenarios.E_REDUCED
UM = 1e-6


def digits(printed: str) -> float:
    """Half a unit in the last printed place, relative to the number."""
    mantissa = printed.lower().split("e")[0]
    places = len(mantissa.split(".")[1])
    return 0.5 * 10.0**-places / abs(float(mantissa))


def at(session: Session, d: float, E: float) -> tuple[float, float]:
    session.set("d", d)
    session.set("E", E)
    return session.get("A_r"), session.get("sigma")


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


def test_combined_modulus() -> None:
    full = reference_contact.combined_modulus(71.3e9, 0.33, 200e9, 0.29)
    softened = reference_contact.combined_modulus(0.7 * 71.3e9, 0.33, 200e9, 0.29)
    assert float(full) == pytest.approx(58.556936170e9, rel=digits("58.556936170"))
    assert float(softened) == pytest.approx(44.575918745e9, rel=digits("44.575918745"))
    assert float(full) == pytest.approx(E_FULL, rel=1e-15)
    assert float(softened) == pytest.approx(E_REDUCED, rel=1e-15)


def test_the_start_values_are_table_1(fmu: FrictionFmu) -> None:
    table_1 = {
        "d": 14e-6,
        "F_C": 55.0,
        "vibration.f": 20e3,
        "contact.R_q": 6e-6,
        "contact.R": 1.7e-6,
        "contact.eta": 47e9,
        "contact.A_n": 1e-4,
        "contact.nu": 0.33,
        "contact.Y": 410e6,
        "contact.c": 17.0,
        "contact.lambda": 3.0,
    }
    with fmu.session() as session:
        assert {name: session.get(name) for name in table_1} == table_1
        assert session.get("E") == pytest.approx(E_FULL, rel=digits("58.556936170"))


@pytest.mark.parametrize(
    ("d", "printed"),
    [(12.9, "8.991595e-7"), (14.0, "5.187698908e-7"), (15.1, "2.993042e-7"), (17.0, "1.157532088e-7")],
)
def test_real_area(fmu: FrictionFmu, d: float, printed: str) -> None:
    with fmu.session() as session:
        A_r, _ = at(session, d * UM, E_FULL)
    assert A_r == pytest.approx(float(printed), rel=digits(printed))
    assert A_r == pytest.approx(float(reference_contact.area(Contact(), d * UM, E_FULL)), rel=1e-13)


@pytest.mark.parametrize(("d", "printed"), [(14.0, "5.743065402e12"), (17.0, "1.596973315e11")])
def test_stiffness(fmu: FrictionFmu, d: float, printed: str) -> None:
    with fmu.session() as session:
        _, sigma = at(session, d * UM, E_FULL)
    assert sigma == pytest.approx(float(printed), rel=digits(printed))
    assert sigma == pytest.approx(float(reference_contact.stiffness(Contact(), d * UM, E_FULL)), rel=1e-13)


# Rough and smooth, soft and hard: x = lambda omega_c / R_q from 1e-4 to 1e2, so that e^-x counts.
CONTACTS = [
    Contact(),
    Contact(R_q=1e-7, R=1e-3, eta=1e11, Y=2e9),
    Contact(R_q=2e-8, R=1e-2, nu=0.0, Y=5e9, c=11.0, lambda_=2.5),
    Contact(nu=0.5, A_n=3e-3, stiffnessScale=1e-6),
    Contact(model="Constant", sigma=3.3e7),
]


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("E", [1e9, E_REDUCED, 3e11])
def test_other_contacts(fmu: FrictionFmu, contact: Contact, E: float) -> None:
    start = {
        f"contact.{name.rstrip('_')}": getattr(contact, name) for name in contact.__dataclass_fields__
    } | {"d": 3.0 * contact.R_q, "E": E}
    with fmu.session(start) as session:
        A_r, sigma = session.get("A_r"), session.get("sigma")
    assert A_r == pytest.approx(float(reference_contact.area(contact, 3.0 * contact.R_q, E)), rel=1e-13)
    assert sigma == pytest.approx(
        float(reference_contact.stiffness(contact, 3.0 * contact.R_q, E)), rel=1e-13
    )


@pytest.mark.parametrize("contact", CONTACTS)
def test_directional_derivatives(fmu: FrictionFmu, contact: Contact) -> None:
    d, E = 2.5 * contact.R_q, 5e10
    start = {
        f"contact.{name.rstrip('_')}": getattr(contact, name) for name in contact.__dataclass_fields__
    } | {"d": d, "E": E}
    reference = {
        "A_r": gradient(reference_contact.area, contact, d, E),
        "sigma": gradient(reference_contact.stiffness, contact, d, E),
    }
    with fmu.session(start) as session:
        for output, expected in reference.items():
            for k, name in enumerate("dE"):
                known = fmu.variables[name].valueReference
                unknown = fmu.variables[output].valueReference
                (slope,) = session.slave.getDirectionalDerivative([unknown], [known], [1.0])
                # where e^-x has vanished, so has the slope of A_r by E: compare on the scale of A_r / E
                scale = session.get(output) / (d, E)[k]
                assert slope == pytest.approx(float(expected[k]), rel=1e-10, abs=1e-13 * scale)
