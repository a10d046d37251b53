"""A user's script, which type checkers must pass in their strictest form, and which runs."""

import copy
import pickle

import numpy as np

import frictioncontact as fc

scene: dict[str, float | str] = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7}
law = fc.friction_law(scene)
force: float = law(0.5)
slope: float = law.derivative(0.5)
forces = np.asarray(law(np.linspace(0.1, 1.0, 5)))
drive = {"time [ms]": [0.0, 0.1], "V [mm/s]": [0.0, 100.0]}
table = fc.simulate(scene, stop=1e-4, step=1e-5, inputs=drive, outputs=["F_t"])
many = fc.simulate_many({"V [mm/s]": [100.0, 200.0], "vibration.V_1": 1.44}, ["F_t_mean"])
print(force, slope, forces.sum(), table["F_t"].mean(), many["F_t_mean"].mean())
steel = fc.contacts["steel-dry"]
start: dict[str, float | str] = {"friction.model": "ElasticPlastic", "contact.model": "Constant"}
assert steel.data is not None
found = fc.identify(steel.data, "contact.sigma", start=start, uncertain={"F_t_mean": 0.05}, nuisance=["sign"])
low, high = found.intervals["contact.sigma"]
again: fc.Identification = pickle.loads(pickle.dumps(copy.deepcopy(found)))
print(again, low, high, again.nuisances, again.misfits, again.remedies)
again.plot().savefig("fit.png")
print(fc.advise(scene, accuracy=1e-3, step=1e-3, output="F_t_mean").settings)
print(fc.advise(scene, mass=1e-3, step=1e-7, master="Gauss-Seidel").start_values)
with fc.FrictionFmu(fc.FMU) as fmu, fmu.session(scene) as contact:
    contact.step(1e-3)
    print(contact, contact.get("F_t_mean"))
