"""The fuzzers' seeds, given once, and a short watch on every call: every condition holds."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tools.build import build_targets

CORPUS = Path(__file__).with_name("corpus")


def run(program: str, *words: object) -> str:
    command = [build_targets("default", [program]) / program, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("fuzzer", ["call_sequence", "model_exchange", "state_bytes"])
def test_seeds(fuzzer: str) -> None:
    seeds = sorted((CORPUS / fuzzer).iterdir())
    assert run(f"replay_{fuzzer}", *seeds) == f"{len(seeds)} inputs\n"


@pytest.mark.skipif(sys.platform != "linux", reason="the watch reads another process's clock")
@pytest.mark.parametrize("numbers", [[], ["--ordinary"]], ids=["of any size", "usual"])
def test_every_call_returns(numbers: list[str]) -> None:
    """Within its work, and in usual scenes without a floating-point trap: as scripts/check watchdog."""
    run("watchdog", 10_000, 1, *numbers)
