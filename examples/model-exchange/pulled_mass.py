"""A host for model exchange by scipy: a mass is pulled over a contact that vibrates, and may stick."""

import shutil
from ctypes import c_double

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Model
from scipy.integrate import BDF, OdeSolver

import frictioncontact as fc


def pulled(
    start: dict[str, float], mass: float, pull: float, stop: float, rtol: float, method: type[OdeSolver] = BDF
) -> tuple[float, float]:
    """The velocity [m/s] of a mass [kg] after stop [s] under a pull [N], and the longest step [s]."""
    known = read_model_description(fc.FMU)
    folder = extract(fc.FMU)
    model = known.modelExchange.modelIdentifier
    fmu = FMU2Model(guid=known.guid, unzipDirectory=folder, modelIdentifier=model, instanceName="contact")
    variables = {v.name: v for v in known.modelVariables}
    V, F_t = ([variables[name].valueReference] for name in ("V", "F_t"))
    four = (c_double * 4)()  # states, rates, indicators, nominal values

    def put(t: float, y: np.ndarray) -> None:
        fmu.setTime(t)
        fmu.setContinuousStates((c_double * 4)(*y[:4]), 4)
        fmu.setReal(V, [y[4]])

    def rates(t: float, y: np.ndarray) -> list[float]:
        put(t, y)
        fmu.getDerivatives(four, 4)
        return [*four, (pull - fmu.getReal(F_t)[0]) / mass]

    def signs(t: float, y: np.ndarray) -> list[bool]:
        put(t, y)
        fmu.getEventIndicators(four, 4)
        return [z > 0 for z in four]

    fmu.instantiate()
    fmu.setupExperiment()
    for name, value in start.items():
        set_value = fmu.setReal if variables[name].type == "Real" else fmu.setInteger
        set_value([variables[name].valueReference], [value])
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    t, v, longest = 0.0, start["V"], 0.0
    while True:
        *_, announced, next_event = fmu.newDiscreteStates()
        fmu.enterContinuousTimeMode()
        if t >= stop:
            break
        fmu.getContinuousStates(four, 4)
        y = np.array([*four, v])
        fmu.getNominalsOfContinuousStates(four, 4)
        end = min(stop, next_event) if announced else stop
        solver = method(rates, t, y, end, rtol=rtol, atol=rtol * np.array([*four, 1.0]))
        before, event = signs(t, y), False
        while solver.status == "running" and not event:
            solver.step()
            longest = max(longest, solver.t - solver.t_old)
            t, y, low = solver.t, solver.y, solver.t_old
            event = signs(t, y) != before
            if event:
                course = solver.dense_output()
                while low < (middle := (low + t) / 2) < t:
                    if signs(middle, course(middle)) == before:
                        low = middle
                    else:
                        t = middle
                y = course(t)
            put(t, y)
            event |= fmu.completedIntegratorStep()[0]
        v = y[4]
        fmu.enterEventMode()
    fmu.freeInstance()
    shutil.rmtree(folder)
    return v, longest


if __name__ == "__main__":
    scene = {"friction.model": 3, "contact.model": 2, "contact.sigma": 10e6, "V": 0.0, "vibration.V_1": 0.5}
    v, longest = pulled(scene, mass=2.0, pull=15.0, stop=40 / 20e3, rtol=1e-6)
    print(f"{1e3 * v:.2f} mm/s")
