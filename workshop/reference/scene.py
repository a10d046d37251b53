"""A scene: what drives one contact, and where its velocity reverses.

V(t) = V + V' (t - start) + V_1 cos(2 pi f t)              (Eq. 24)
d(t) = d + d' (t - start) + a_d cos(2 pi f t + phase_d)    (section 3.2)
E(t) = E + E' (t - start)
load(t) = load + load' (t - start)

Where the load is given, the surfaces rest where the time mean of F_n over a period is the load:
d = d_rest(t) + a_d cos(2 pi f t + phase_d),    d_rest = (R_q / lambda) ln(F_n(0) I0(lambda a_d / R_q) / load)
"""

from dataclasses import dataclass, field
from typing import Any

from frictioncontact.parameters import COULOMB_FORCE, FREQUENCY, SEPARATION, VELOCITY_PRINTED
from workshop.reference.arithmetic import MP, Arithmetic
from workshop.reference.coefficients import ContactCoefficients
from workshop.reference.contact import Contact


@dataclass(frozen=True)
class Scene:
    V: float = VELOCITY_PRINTED  # m/s
    d: float = SEPARATION  # m
    E: float = 58.556936170e9  # Pa
    V_rate: float = 0.0  # m/s2
    d_rate: float = 0.0  # m/s
    E_rate: float = 0.0  # Pa/s
    load: float = 312.44  # N, where input is Load
    load_rate: float = 0.0  # N/s
    start: float = 0.0  # s, when the inputs have the values above
    f: float = FREQUENCY  # Hz
    V_1: float = 0.0  # m/s
    a_d: float = 0.0  # m
    phase_d: float = 0.0  # rad
    F_C: float = COULOMB_FORCE  # N
    friction: str = "Dahl"
    limit: str = "Constant"  # F_C, or Load: mu F_n(t)
    mu: float = 0.176
    staticRatio: float = 1.0  # LuGre and ElasticPlastic
    V_S: float = 0.01  # m/s
    sigma_1: float = 0.0  # N s/m
    sigma_2: float = 0.0  # N s/m
    input: str = "Separation"  # d, or Load: load
    contact: Contact = field(default_factory=Contact)

    @property
    def vibrates(self) -> bool:
        return self.V_1 != 0.0 or self.a_d != 0.0

    @property
    def bounded(self) -> bool:
        """Whether the bristle's force has a bound."""
        return self.friction == "ElasticPlastic" or (
            self.limit == "Load" and self.friction in ("Dahl", "LuGre")
        )

    @property
    def drops(self) -> bool:
        """Whether break-away is a drop, from the static to the kinetic bound."""
        return self.friction == "ElasticPlastic" and self.staticRatio > 1.0

    @property
    def needs_load(self) -> bool:
        """Whether an open contact has no bristle."""
        return self.limit == "Load" or self.contact.model != "Constant"

    @property
    def held(self) -> bool:
        return not any((self.V_rate, self.d_rate, self.E_rate, self.load_rate))

    @property
    def period(self) -> Any:
        return 1 / MP.mpf(self.f)


class Drive:
    """V, d, sigma on local time tau = t - t0, for numbers or arrays of one arithmetic."""

    def __init__(self, scene: Scene, t0: Any, arithmetic: Arithmetic) -> None:
        self.t0 = t0
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
        self.load_0, self.load_rate = real(scene.load + lead * MP.mpf(scene.load_rate)), real(scene.load_rate)
        excess = MP.mpf(scene.staticRatio) - 1 if scene.friction in ("LuGre", "ElasticPlastic") else 0
        self.mu, self.excess, self.V_S = real(scene.mu), real(excess), real(scene.V_S)
        self.sigma_1, self.sigma_2 = real(scene.sigma_1), real(scene.sigma_2)
        contact = scene.contact
        decay = MP.mpf(contact.lambda_) / MP.mpf(contact.R_q)
        self.decay = real(decay)
        self.swell = real(MP.besseli(0, decay * MP.mpf(scene.a_d)))
        self.coefficients = ContactCoefficients(contact, scene.E, arithmetic)
        self._held: dict[str, Any] = {}

    def theta(self, tau: Any) -> Any:
        return self.omega * tau + self.theta_0

    def V(self, tau: Any) -> Any:
        return self.V_0 + self.V_rate * tau + self.V_1 * self.arithmetic.cos(self.theta(tau))

    def load(self, tau: Any) -> Any:
        return self.load_0 + self.load_rate * tau

    def d(self, tau: Any) -> Any:
        vibration = self.a_d * self.arithmetic.cos(self.theta(tau) + self.phase_d)
        return self.rest(tau) + vibration

    def rest(self, tau: Any) -> Any:
        """The separation without vibration."""
        if self.scene.input == "Separation":
            return self.d_0 + self.d_rate * tau
        pressed = self._of_E("normal_force", tau) * self.swell
        return self.arithmetic.log(pressed / self.load(tau)) / self.decay

    def E(self, tau: Any) -> Any:
        return self.E_0 + self.E_rate * tau if self.E_rate != 0 else self.E_0

    def _of_E(self, name: str, tau: Any) -> Any:
        """A coefficient of the contact, computed once where E is held."""
        coefficient = getattr(self.coefficients, name)
        if self.E_rate != 0:
            return coefficient(self.E(tau))
        if name not in self._held:
            self._held[name] = coefficient(self.E_0)
        return self._held[name]

    def normal_force(self, tau: Any) -> Any:
        """F_n [N]."""
        close = self.arithmetic.exp(-self.decay * self.d(tau))
        return self._of_E("normal_force", tau) * close

    def sigma(self, tau: Any) -> Any:
        """Tangential stiffness [N/m]; tests hold it equal to `contact`.stiffness."""
        contact = self.scene.contact
        if contact.model == "Constant":
            return self.arithmetic.real(contact.sigma) + 0 * tau
        d = self.d(tau)
        close = self.arithmetic.exp(-self.decay * d)
        if contact.model == "Mindlin":
            return self._of_E("mindlin", tau) * close
        return self._of_E("asperities", tau) * close * close / (d * d * d)

    def coulomb(self, tau: Any) -> Any:
        """F_C(t) [N]: the constant, or mu F_n(t)."""
        if self.scene.limit == "Load":
            return self.mu * self.normal_force(tau)
        return self.F_C + 0 * tau

    def curve(self, tau: Any) -> Any:
        """Stribeck's, g over F_C."""
        if self.excess == 0:
            return 1
        slowness = self.V(tau) / self.V_S
        return 1 + self.excess * self.arithmetic.exp(-(slowness * slowness))

    def limit(self, tau: Any) -> Any:
        """g [N]: what sigma |delta| tends to while the contact slides."""
        return self.coulomb(tau) * self.curve(tau)

    def bound(self, tau: Any) -> Any:
        """D [m] of |delta|: g / sigma in ElasticPlastic (kinetic), else with the largest g at any V."""
        sticks = self.scene.friction == "ElasticPlastic"
        largest = self.curve(tau) if sticks else 1 + self.excess
        return self.coulomb(tau) * largest / self.sigma(tau)

    def static_bound(self, tau: Any) -> Any:
        """D_s [m], which a bristle that sticks breaks away at, whatever V is."""
        return self.coulomb(tau) * (1 + self.excess) / self.sigma(tau)

    def bound_over_limit(self, tau: Any) -> Any:
        """k of a bristle on its bound, which relaxes by k |V| [m/s]: exactly 1 in Dahl, 0 where it sticks."""
        return 0 if self.scene.friction == "ElasticPlastic" else (1 + self.excess) / self.curve(tau)

    def relaxation_rate(self, tau: Any) -> Any:
        """r = sigma |V| / g [1/s], 0 in ElasticPlastic."""
        if self.scene.friction == "ElasticPlastic":
            return 0 * tau
        return self.sigma(tau) * abs(self.V(tau)) / self.limit(tau)


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
