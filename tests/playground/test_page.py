"""The page itself: accessible, sized to phone and desktop, and one file that loads nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playground_page import Playground
from playwright.sync_api import Browser

from tools.browser import SIZES
from tools.playground.command import SCHEMES

# A browser that compiles only beside the page, and knows no base64.
OLDER = """delete Uint8Array.fromBase64;
WebAssembly.Module = function () { throw new RangeError("too large for the main thread"); };"""


@pytest.mark.parametrize(("size", "scheme"), [*zip(SIZES, SCHEMES, strict=True)])
def test_no_barrier_is_found(browser: Browser, html: Path, size: str, scheme: str) -> None:
    """By axe-core, whose rules are those of WCAG; and nothing is wider than the window."""
    width, height = SIZES[size]
    look = {"viewport": {"width": width, "height": height}, "color_scheme": scheme}
    context = browser.new_context(**look, bypass_csp=True)
    if scheme == SCHEMES[0]:
        context.add_init_script(OLDER)
    playground = Playground(context.new_page(), html)
    playground.open()
    playground.finish()
    found = Axe().run(playground.page)
    scroll_width = playground.page.evaluate("document.documentElement.scrollWidth")
    context.close()
    assert [f"{rule['id']}: {rule['help']}" for rule in found.response["violations"]] == []
    assert scroll_width == width
    assert playground.problems == []


def test_the_core_imports_nothing(playground: Playground, html: Path) -> None:
    assert "default-src 'none'" in html.read_text(encoding="utf-8")
    imports, exports = playground.page.evaluate(
        """async () => {
            const text = atob(document.getElementById("wasm").textContent);
            const module = await WebAssembly.compile(Uint8Array.from(text, (c) => c.charCodeAt(0)));
            const names = (list) => list.map(({ name }) => name);
            return [names(WebAssembly.Module.imports(module)), names(WebAssembly.Module.exports(module))];
        }"""
    )
    assert imports == []
    assert {"fmi2DoStep", "fmi2SetReal", "fmi2GetReal", "fmi2Reset", "host_message"} <= set(exports)


def test_the_plane_is_shown_when_something_moves_in_it(playground: Playground) -> None:
    """The path of the force in place of the loop, the transverse force beside the one along."""
    for scene, is_plane in (({"V": 0.3, "V_y": 0.1}, True), ({"V": 0.3, "vibration.V_1": 1.0}, False)):
        playground.load({"contact.stiffnessScale": 5e-7} | scene)
        assert ("Path of the force" in playground.page.locator("#loop-title").inner_text()) == is_plane
        assert playground.page.locator("#force .line.transverse").count() == int(is_plane)
        for name in ("#transverse-mean", "#transverse-key"):
            assert playground.page.locator(name).is_visible() == is_plane
    playground.load({"V": 0.3, "vibration.V_2": 1.0, "contact.stiffnessScale": 5e-7})
    ring = playground.page.locator("#loop .line.coulomb").bounding_box()
    assert ring is not None and ring["width"] == pytest.approx(ring["height"], abs=1.0)
    playground.finish()
    assert playground.page.locator("#map-none").is_hidden()
    assert "V2" in playground.page.locator("#map-y").inner_text().replace("\n", "")
