"""The page's numbers are those of the FMU's shared library: the same C, another compiler and C library."""

from __future__ import annotations

import math

import numpy as np
import pytest
from playground_page import Playground, native_wave
from scipy.special import ellipk

from frictioncontact.fmu import FrictionFmu
from tools.presets import Preset

LIMIT = 1e-12  # of the largest force: another C library rounds exp and cos otherwise
TOLERANCE = 1e-6  # solver.tolerance, relative to F_C

# Another core in the page's own script.
CORE = (
    "new Fmu(await WebAssembly.compile(Uint8Array.fromBase64(document.getElementById('wasm').textContent)),"
    " description)"
)
CONSTANT_STIFFNESS = {"contact.model": "Constant", "vibration.V_1": 1.0, "vibration.f": 20e3, "F_C": 55.0}


def test_every_preset_equals_the_shared_library(
    playground: Playground, fmu: FrictionFmu, offered: list[Preset]
) -> None:
    assert len(offered) >= 13
    for preset in offered:
        playground.choose(preset)
        native, shown = native_wave(fmu, preset.values), playground.wave()
        size = float(np.hypot(native["F_t_N"], native["F_y_N"]).max())

        def near(value: object, scale: float = size) -> object:
            return pytest.approx(value, rel=0, abs=LIMIT * scale)

        for name in ("F_t_N", "F_y_N"):
            assert shown[name] == near(native[name]), preset.id
        along, transverse = native["means"]
        assert playground.number("mean-force") == near(along), preset.id
        limit = 3e-6 if abs(transverse) < 1e-3 * size else LIMIT  # below, 0 is shown
        assert playground.number("transverse-mean") == pytest.approx(transverse, rel=0, abs=limit * size)
        speeds = ("V", "V_y", "vibration.V_1", "vibration.V_2")
        path = sum(abs(preset.values.get(name, 0.0)) for name in speeds)  # m/s, at most
        energy = size * path / preset.values.get("vibration.f", 20e3)  # J a period, at most
        for name, number in zip(("work", "heat"), native["energies"], strict=True):
            assert playground.number(name) == near(number, energy), preset.id
        if preset.known is not None:
            assert playground.number("known") == preset.known
        assert playground.page.locator("#known").is_visible() == (preset.known is not None)


def test_the_curves_of_a_rigid_contact_are_the_formulas(playground: Playground) -> None:
    places = np.geomspace(1e-4, 10.0, 9)
    for scene, formula in (
        ({"vibration.V_1": 1.0}, 2 / np.pi * np.arcsin(np.minimum(places, 1.0))),
        (
            {"vibration.V_2": 1.0},
            2 / np.pi * places / np.hypot(1.0, places) * ellipk(1.0 / (1.0 + places**2)),
        ),
    ):
        found = playground.page.evaluate(
            "([values, places]) => places.map(rigid(values).mean)", [scene, places.tolist()]
        )
        assert found == pytest.approx(formula, rel=1e-12)
    for scene in ({}, {"vibration.V_1": 1.0, "vibration.V_2": 1.0}, {"vibration.V_1": 1.0, "V_y": 0.1}):
        assert playground.page.evaluate("values => rigid(values)", scene) is None


@pytest.mark.parametrize("drive", [{"vibration.V_1": 1.0}, {"vibration.V_2": 1.0, "V_y": 0.4}])
def test_curve_and_map_are_the_means_at_their_places(
    playground: Playground, fmu: FrictionFmu, drive: dict[str, float]
) -> None:
    """Both are over the friction of steady sliding, which with oblique sliding is 55 N in the plane."""
    scene = CONSTANT_STIFFNESS | {"vibration.V_1": 0.0} | drive
    curve, cells = playground.page.evaluate(
        f"""async (values) => {{
            const fmu = await {CORE};
            const found = curve(fmu, values, 4);
            return [[[...found.x], [...found.y]], [...regimeMap(fmu, values, 2, 2)]];
        }}""",
        scene,
    )
    corners = [
        {"V": zeta, "contact.sigma": kappa * 2 * math.pi * 20e3 * 55.0}
        for zeta in (1e-4, 10.0)
        for kappa in (1e-2, 1e7)
    ]
    for changed, found in zip([*({"V": V} for V in curve[0]), *corners], [*curve[1], *cells], strict=True):
        with fmu.session(scene | changed) as session:
            assert found == pytest.approx(session.get("F_t_settled") / 55.0, abs=4 * TOLERANCE)
