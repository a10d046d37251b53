"""The page as a person uses it, in a browser that tells what a page must not do, and the FMU beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from playwright.sync_api import Page

from frictioncontact.fmu import FrictionFmu, Value
from tools.browser import watch
from tools.presets import Preset

# The page's worker computes curves and map of each scene shown: it starts where a test waits for them.
HELD_WORKER = """{
    const Started = Worker;
    Worker = class {
        posted = [];
        constructor(source) { globalThis.startWorker = () => this.start(source); }
        postMessage(data) { this.posted = [...this.posted.slice(0, 1), data]; }
        start(source) {
            const worker = new Started(source);
            worker.onmessage = this.onmessage;
            this.postMessage = (data) => worker.postMessage(data);
            this.posted.forEach(this.postMessage);
            globalThis.startWorker = () => {};
        }
    };
}"""


class Playground:
    """problems: errors, warnings, requests beyond the page's own file."""

    def __init__(self, page: Page, html: Path) -> None:
        self.page = page
        self.address = html.as_uri()
        self.problems: list[str] = []
        watch(page, html, self.problems)
        page.add_init_script(HELD_WORKER)

    def open(self, words: str = "") -> None:
        self.page.goto("about:blank")
        self.page.goto(self.address + words)
        self.page.wait_for_selector("body.ready")
        self.settle()  # until then the page would write its first address over the next

    def load(self, values: Mapping[str, float | str]) -> None:
        """Goes to the address of a scene, on the page that is open."""
        words = "&".join(f"{name}={value}" for name, value in values.items())
        self.page.evaluate(
            "words => { document.body.dataset.address = 'busy'; location.hash = ''; location.hash = words; }",
            words,
        )
        self.settle()

    def choose(self, preset: Preset) -> None:
        self.page.locator("#preset").select_option(preset.id)
        self.settle()

    def settle(self) -> None:
        """Waits until figures, numbers and texts are those of the scene."""
        self.page.wait_for_selector("body[data-address=done]")

    def finish(self) -> None:
        """Waits for curves and map as well."""
        self.settle()
        self.page.evaluate("startWorker()")
        self.page.wait_for_selector("body[data-worker=done]")

    def number(self, name: str) -> float:
        """A number above the figures, in SI and in full."""
        return float(self.page.locator(f"#{name}").get_attribute("value") or "nan")

    def text(self, kind: str) -> str:
        """What Copy as gives."""
        self.page.locator(f'[data-kind="{kind}"]').click()
        return self.page.locator("#copy-text").input_value()

    def wave(self) -> dict[str, list[float]]:
        """The columns of the data of the first figures."""
        names, *rows = (line.split(",") for line in self.text("CSV").splitlines())
        return {name: [float(row[k]) for row in rows] for k, name in enumerate(names)}

    def enter(self, variable: str, text: str) -> None:
        field = self.page.locator(f'[data-variable="{variable}"] input[type=text]')
        field.fill(text)
        field.press("Enter")
        self.settle()

    def pick(self, variable: str, item: str) -> None:
        self.page.locator(f'[data-variable="{variable}"] select').select_option(item)
        self.settle()

    def refusal(self, variable: str) -> str:
        return self.page.locator(f'[data-variable="{variable}"] .refusal').inner_text()


def native_wave(fmu: FrictionFmu, values: Mapping[str, Value]) -> dict[str, list[float]]:
    """The same numbers from the FMU's shared library: the calls of the page's wave, made through fmpy."""
    samples, periods = 240, 2
    with fmu.session(values) as session:
        step = 1.0 / session.get("vibration.f") / samples
        before, rows = session.read(["W_f", "Q_f"]), [session.read(["F_t", "F_y"])]
        for _ in range(periods * samples):
            session.step(step)
            rows.append(session.read(["F_t", "F_y"]))
        energies = (session.read(["W_f", "Q_f"]) - before) / periods
        means = session.read(["F_t_settled", "F_y_settled"])
    forces = np.transpose(rows).tolist()
    return {"F_t_N": forces[0], "F_y_N": forces[1], "means": [*means], "energies": [*energies]}
