"""The page's numbers are those of the FMU's shared library: the same C, another compiler and C library."""

from __future__ import annotations

import math

import numpy as np
import pytest
from native_wave import wave
from playground_page import Playground

from frictioncontact.fmu import FrictionFmu
from frictioncontact.periodic import periodic_mean
from workshop.presets import Preset

LIMIT = 1e-12  # of the largest force: another C library rounds exp and cos otherwise
TOLERANCE = 1e-6  # solver.tolerance, relative to F_C

# Exact periodic means over F_C of Dahl's law with constant stiffness: kappa, zeta, mean.
EXACT_MEANS = ((1.0, 0.1, 0.122328249), (2.0, 0.25, 0.227294259), (5.0, 0.5, 0.379341496))
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
        native = wave(fmu, preset.values)
        size = max(map(abs, native.force))
        np.testing.assert_allclose(playground.wave()["F_t_N"], native.force, rtol=0, atol=LIMIT * size)
        assert playground.number("mean-force") == pytest.approx(native.mean, abs=LIMIT * size), preset.id
        path = abs(preset.values["V"]) + preset.values.get("vibration.V_1", 0.0)  # m/s, at most
        energy = size * path / preset.values["vibration.f"]  # J a period, at most
        assert playground.number("work") == pytest.approx(native.work, abs=LIMIT * energy), preset.id
        assert playground.number("heat") == pytest.approx(native.heat, abs=LIMIT * energy), preset.id


def test_the_mean_is_that_of_the_periodic_state(
    playground: Playground, fmu: FrictionFmu, offered: list[Preset]
) -> None:
    for preset in offered:
        playground.choose(preset)
        limit = fmu.variables["F_C"].start if "F_C" not in preset.values else preset.values["F_C"]
        expected = periodic_mean(fmu, preset.values)
        assert playground.number("mean-force") == pytest.approx(expected, abs=2 * TOLERANCE * float(limit))


def test_curve_and_map_go_through_the_exact_means(playground: Playground) -> None:
    """Evaluated at the places for which the means are known."""
    for kappa, zeta, mean in EXACT_MEANS:
        found = playground.page.evaluate(
            f"""async ([values, kappa, zeta]) => {{
                const fmu = await {CORE};
                const scene = sceneAt(fmu, values, kappa, zeta);
                const there = regime(fmu, scene);
                return [there.kappa, there.zeta, meanForce(fmu, scene), there.limit];
            }}""",
            [CONSTANT_STIFFNESS, kappa, zeta],
        )
        assert found[:2] == pytest.approx([kappa, zeta], rel=1e-12)
        assert found[2] / found[3] == pytest.approx(mean, abs=TOLERANCE)


def test_the_map_is_the_mean_at_each_of_its_places(playground: Playground, fmu: FrictionFmu) -> None:
    columns, rows = 4, 3
    rows_found = playground.page.evaluate(
        f"""async ([values, columns, rows]) => {{
            const fmu = await {CORE};
            return [...regimeMap(fmu, values, columns, rows)].map((row) => [...row]);
        }}""",
        [CONSTANT_STIFFNESS, columns, rows],
    )
    kappas = np.geomspace(1e-2, 1e7, columns)
    zetas = np.geomspace(1e-4, 10.0, rows)
    for zeta, row in zip(zetas, rows_found, strict=True):
        for kappa, found in zip(kappas, row, strict=True):
            sigma = kappa * 2 * math.pi * 20e3 * 55.0
            expected = periodic_mean(fmu, CONSTANT_STIFFNESS | {"V": zeta, "contact.sigma": sigma})
            assert found == pytest.approx(expected / 55.0, abs=4 * TOLERANCE)


def test_the_known_number_stands_beside(playground: Playground, offered: list[Preset]) -> None:
    for preset in offered:
        playground.choose(preset)
        shown = playground.page.locator("#known").is_visible()
        assert shown == (preset.known is not None)
        if preset.known is not None:
            assert playground.number("known") == preset.known
            assert playground.page.locator("#known-from").inner_text() == preset.known_from
