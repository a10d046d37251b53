"""A scene: what drives one contact, and where its velocity reverses.

V(t) = V + V' (t - start) + V_1 cos(2 pi f t)              (Eq. 24)
d(t) = d + d' (t - start) + a_d cos(2 pi f t + phase_d)    (section 3.2)
E(t) = E + E' (t - start)
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from frictionlab.parameters import COULOMB_FORCE, FREQUENCY, SEPARATION, VELOCITY_PRINTED
from frictionlab.reference.arithmetic import MP, Arithmetic
from frictionlab.reference.contact import Contact, critical_interference, roughness


@dataclass(frozen=True)
class Scene:
    V: float = VELOCITY_PRINTED  # m/s
    d: float = SEPARATION  # m
    E: float = 58.556936170e9  # Pa
    V_rate: float = 0.0  # m/s2
    d_rate: float = 0.0  # m/s
    E_rate: float = 0.0  # Pa/s
    start: float = 0.0  # s, when the inputs have the values above
    f: float = FREQUENCY  # Hz
    V_1: float = 0.0  # m/s
    a_d: float = 0.0  # m
    phase_d: float = 0.0  # rad
    F_C: float = COULOMB_FORCE  # N
    friction: str = "Dahl"
    contact: Contact = field(default_factory=Contact)

    @property
    def vibrates(self) -> bool:
        return self.V_1 != 0.0 or self.a_d != 0.0

    @property
    def held(self) -> bool:
        return self.V_rate == 0.0 and self.d_rate == 0.0 and self.E_rate == 0.0

    @property
    def period(self) -> Any:
        return 1 / MP.mpf(self.f)


class Drive:
    """V, d, sigma on local time tau = t - t0, for numbers or arrays of one arithmetic."""

    def __init__(self, scene: Scene, t0: Any, arithmetic: Arithmetic) -> None:
        real = arithmetic.real
        lead = MP.mpf(t0) - MP.mpf(scene.start)
        self.arithmetic = arithmetic
        self.scene = scene
        cycles = MP.mpf(scene.f) * MP.mpf(t0)
        self.omega = real(2 * MP.pi * MP.mpf(scene.f))
        self.theta_0 = real(2 * MP.pi * (cycles - MP.floor(cycles)))
        self.phase_d = real(MP.mpf(scene.phase_d))
        self.V_1, self.a_d, self.F_C = real(scene.V_1), real(scene.a_d), real(scene.F_C)
        self.V_0, self.V_rate = real(scene.V + lead * MP.mpf(scene.V_rate)), real(scene.V_rate)
        self.d_0, self.d_rate = real(scene.d + lead * MP.mpf(scene.d_rate)), real(scene.d_rate)
        self.E_0, self.E_rate = real(scene.E + lead * MP.mpf(scene.E_rate)), real(scene.E_rate)
        contact = scene.contact
        lam, R_q = MP.mpf(contact.lambda_), MP.mpf(contact.R_q)
        front = MP.mpf(contact.c) * MP.pi * roughness(contact) * MP.mpf(contact.A_n) / lam**2
        self.front = real(MP.mpf(contact.stiffnessScale) * front**2)
        self.decay = real(lam / R_q)
        # x = lambda omega_c / R_q goes with 1 / E^2
        self.x_E2 = real(lam * critical_interference(contact, 1) / R_q)
        self.constant = real(contact.sigma) if contact.model == "Constant" else None

    def theta(self, tau: Any) -> Any:
        return self.omega * tau + self.theta_0

    def V(self, tau: Any) -> Any:
        return self.V_0 + self.V_rate * tau + self.V_1 * self.arithmetic.cos(self.theta(tau))

    def d(self, tau: Any) -> Any:
        vibration = self.a_d * self.arithmetic.cos(self.theta(tau) + self.phase_d)
        return self.d_0 + self.d_rate * tau + vibration

    def E(self, tau: Any) -> Any:
        return self.E_0 + self.E_rate * tau

    def sigma(self, tau: Any) -> Any:
        """Eq. 3 with Eq. 20-22 contracted; a test holds it equal to `contact`.stiffness."""
        if self.constant is not None:
            return self.constant + 0 * tau
        exp, d, E = self.arithmetic.exp, self.d(tau), self.E(tau)
        bracket = 1 + exp(-self.x_E2 / (E * E))
        return self.front * E * bracket * bracket * exp(-2 * self.decay * d) / (d * d * d)

    def relaxation_rate(self, tau: Any) -> Any:
        """sigma |V| / F_C [1/s]."""
        return self.sigma(tau) * abs(self.V(tau)) / self.F_C


def events(drive: Drive, h: Any) -> list:
    """Local times in (0, h) where V changes sign or |V| has a local minimum; drive in multiprecision."""
    corners = [MP.mpf(0), *_critical_times(drive, h), h]
    found = []
    for left, right in zip(corners[:-1], corners[1:], strict=True):
        if drive.V(left) * drive.V(right) < 0:
            found.append(_root(drive, left, right))
    for tau in corners[1:-1]:
        curvature = -drive.V_1 * drive.omega**2 * MP.cos(drive.theta(tau))
        if drive.V(tau) * curvature >= 0:
            found.append(tau)
    return sorted(tau for tau in found if 0 < tau < h)


def _critical_times(drive: Drive, h: Any) -> list:
    """Where dV/dt = V' - V_1 omega sin(theta) = 0."""
    if drive.V_1 == 0:
        return []
    ratio = drive.V_rate / (drive.V_1 * drive.omega)
    if abs(ratio) >= 1:
        return []
    times = []
    for angle in (MP.asin(ratio), MP.pi - MP.asin(ratio)):
        first = MP.ceil((drive.theta_0 - angle) / (2 * MP.pi))
        last = MP.floor((drive.theta_0 + drive.omega * h - angle) / (2 * MP.pi))
        times += [
            (angle + 2 * MP.pi * k - drive.theta_0) / drive.omega for k in range(int(first), int(last) + 1)
        ]
    return sorted(tau for tau in times if 0 < tau < h)


def _root(drive: Drive, left: Any, right: Any) -> Any:
    """V is monotone between left and right and changes sign: Newton, kept inside by bisection."""
    rising = drive.V(right) > 0
    tau = (left + right) / 2
    for _ in range(400):
        V = drive.V(tau)
        if V == 0:
            return tau
        if (V > 0) == rising:
            right = tau
        else:
            left = tau
        slope = drive.V_rate - drive.V_1 * drive.omega * MP.sin(drive.theta(tau))
        step = tau - V / slope if slope != 0 else left
        following = step if left < step < right else (left + right) / 2
        if abs(following - tau) <= MP.mpf(10) ** (4 - MP.dps) * (right - left + abs(tau)):
            return following
        tau = following
    return tau
