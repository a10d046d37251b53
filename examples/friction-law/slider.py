"""A slider on an ultrasonic contact, driven by its friction law: a differential equation of two states.

Needs the package alone: python slider.py
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

import frictioncontact as fc

SCENE = {  # row 2 of the paper's Table 2, with the identified stiffness and phase
    "E": 44.575918745e9,
    "contact.stiffnessScale": 4.4168e-7,
    "vibration.V_1": 1.44,
    "vibration.a_d": 1.1e-6,
    "vibration.phase_d": 3.9259436,
}
M, K, C, DRIVE = 2.0, 2e4, 40.0, 0.5  # kg, N/m, N s/m, m/s


def slide(duration: float = 0.1, points: int = 101, rtol: float = 1e-5) -> tuple[np.ndarray, np.ndarray, int]:
    """Times [s], positions behind the drive [m], and how often the friction was asked for.

    The ultrasound is switched on at time 0, when the slider is in steady sliding with 55 N.
    """
    law, calls = fc.friction_law(SCENE), 0

    def rates(t: float, y: np.ndarray) -> list[float]:
        nonlocal calls
        calls += 1
        x, v = y
        return [v, (law(DRIVE - v) - K * x - C * v) / M]

    times = np.linspace(0.0, duration, points)
    found = solve_ivp(rates, (0.0, duration), [55.0 / K, 0.0], "LSODA", t_eval=times, rtol=rtol, atol=1e-7)
    return times, found.y[0], calls


if __name__ == "__main__":
    times, x, calls = slide()
    for t, position in list(zip(times, x, strict=True))[::10]:
        print(f"{1e3 * t:5.0f} ms {1e3 * position:8.4f} mm")
    print(f"{calls} calls of the friction law")
