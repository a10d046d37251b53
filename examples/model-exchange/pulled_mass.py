"""A mass is pulled over a contact that vibrates, and may stick: one integrator of scipy takes both."""

from scipy.integrate import BDF, OdeSolver

import frictioncontact as fc


def pulled(
    start: dict[str, float | str],
    mass: float,
    pull: float,
    stop: float,
    rtol: float,
    method: type[OdeSolver] = BDF,
) -> tuple[float, float]:
    """The velocity [m/s] of a mass [kg] after stop [s] under a pull [N], and the longest step [s]."""
    host = fc.ModelExchange(
        start,
        own=[start["V"]],
        inputs=lambda t, own: {"V": own[0]},
        rates=lambda t, own, F_t: [(pull - F_t) / mass],
        tolerance=rtol,
        method=method,
    )
    with host:
        host.advance(stop)
        return host.own[0], host.longest


if __name__ == "__main__":
    scene = {"friction.model": "ElasticPlastic", "contact.model": "Constant", "contact.sigma": 10e6}
    v, longest = pulled(
        scene | {"V": 0.0, "vibration.V_1": 0.5}, mass=2.0, pull=15.0, stop=40 / 20e3, rtol=1e-6
    )
    print(f"{1e3 * v:.2f} mm/s")
