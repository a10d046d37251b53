"""The report page in headless Chromium, by its DevTools protocol: screenshots, and what is wrong with it."""

from __future__ import annotations

import asyncio
import base64
import json
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tornado.websocket import WebSocketClientConnection, websocket_connect

from frictionlab.project import UserError

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
)
DEADLINE = 60.0  # s, for anything the browser is asked
WIDTHS = {"phone": 390, "tablet": 820, "desktop": 1440}
DRAW_ALL = "boxes.forEach(draw); boxes.every((box) => box.querySelector('.main-svg'))"


@dataclass
class Visit:
    """What one visit of the page found."""

    width: int
    scroll_width: int
    drawn: bool
    problems: list[str] = field(default_factory=list)  # errors of the script, requests to the network


def find_browser() -> str | None:
    return next((path for name in NAMES if (path := shutil.which(name))), None)


def visit(
    page: Path, width: int, dark: bool, screenshot: Path | None = None, tall: int | None = None
) -> Visit:
    """Opens the page at a width [px]; a screenshot is of the whole page or of its first tall px."""
    browser = find_browser()
    if browser is None:
        raise UserError("no Chromium is installed; on Debian or Ubuntu: sudo apt-get install chromium")
    profile = Path(tempfile.mkdtemp(prefix="report-browser-"))
    process = subprocess.Popen(
        [browser, *OPTIONS, f"--user-data-dir={profile}", "about:blank"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        address = _address(profile / "DevToolsActivePort", process)
        return asyncio.run(_visit(address, page, width, dark, screenshot, tall))
    finally:
        process.terminate()
        try:
            process.wait(10.0)
        except subprocess.TimeoutExpired:
            process.kill()
        shutil.rmtree(profile, ignore_errors=True)


def _address(file: Path, process: subprocess.Popen) -> str:
    end = time.monotonic() + DEADLINE
    while time.monotonic() < end and process.poll() is None:
        lines = file.read_text().splitlines() if file.is_file() else []
        if len(lines) >= 2:
            return f"ws://127.0.0.1:{lines[0]}{lines[1]}"
        time.sleep(0.05)
    raise UserError("Chromium does not start")


class _Tab:
    """Commands to one page of the browser, and the events that it sends in between."""

    def __init__(self, socket: WebSocketClientConnection) -> None:
        self.socket, self.session, self.number = socket, "", 0
        self.events: list[dict[str, Any]] = []

    async def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        await self.socket.write_message(json.dumps(message))
        while True:
            answer = await self._receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise UserError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    async def wait_for(self, event: str) -> None:
        while not any(known["method"] == event for known in self.events):
            await self._receive()

    async def evaluate(self, script: str) -> Any:
        result = await self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise UserError(result["exceptionDetails"]["exception"].get("description", script))
        return result["result"].get("value")

    async def _receive(self) -> dict[str, Any]:
        text = await asyncio.wait_for(self.socket.read_message(), DEADLINE)
        if text is None:
            raise UserError("Chromium closed the connection")
        message = json.loads(text)
        if "method" in message:
            self.events.append(message)
        return message


async def _visit(
    address: str, page: Path, width: int, dark: bool, screenshot: Path | None, tall: int | None
) -> Visit:
    tab = _Tab(await websocket_connect(address, max_message_size=256 * 2**20))
    target = await tab.call("Target.createTarget", url="about:blank")
    attached = await tab.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)
    tab.session = attached["sessionId"]
    for domain in ("Page", "Runtime", "Network", "Log"):
        await tab.call(f"{domain}.enable")
    await tab.call(
        "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600
    )
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    await tab.call("Emulation.setEmulatedMedia", features=[scheme])
    await tab.call("Page.navigate", url=page.resolve().as_uri())
    await tab.wait_for("Page.loadEventFired")
    drawn = await tab.evaluate(DRAW_ALL)
    await tab.evaluate("new Promise((done) => setTimeout(done, 400))")
    scroll_width = await tab.evaluate("document.documentElement.scrollWidth")
    theme = await tab.evaluate("document.documentElement.dataset.theme")
    if screenshot is not None:
        height = await tab.evaluate("document.documentElement.scrollHeight")
        clip = {"x": 0, "y": 0, "width": width, "height": min(height, tall or height), "scale": 1}
        image = await tab.call("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
        screenshot.parent.mkdir(parents=True, exist_ok=True)
        screenshot.write_bytes(base64.b64decode(image["data"]))
    problems = [problem for event in tab.events if (problem := _problem(event))]
    if theme != ("dark" if dark else "light"):
        problems.append(f"the page is {theme}, not what the reader prefers")
    return Visit(width, scroll_width, bool(drawn), problems)


def _problem(event: dict[str, Any]) -> str | None:
    parameters = event.get("params", {})
    match event["method"]:
        case "Runtime.exceptionThrown":
            return f"script error: {parameters['exceptionDetails'].get('text')}"
        case "Log.entryAdded" if parameters["entry"]["level"] == "error":
            return f"log: {parameters['entry']['text']}"
        case "Network.requestWillBeSent":
            url = parameters["request"]["url"]
            return None if url.startswith(("file:", "data:", "blob:")) else f"request to the network: {url}"
    return None
