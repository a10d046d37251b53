"""Every call returns within a second, whatever the numbers; usual scenes raise no floating-point trap."""

from __future__ import annotations

import subprocess
import sys

import pytest

from workshop.build import build_targets

CALLS = "10000"


@pytest.mark.skipif(sys.platform != "linux", reason="the watch reads another process's clock")
@pytest.mark.parametrize("numbers", [[], ["--ordinary"]], ids=["of any size", "usual"])
def test_every_call_returns(numbers: list[str]) -> None:
    """The quick form of scripts/check watchdog."""
    program = build_targets("default", ["watchdog"]) / "watchdog"
    done = subprocess.run([program, CALLS, "1", *numbers], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
