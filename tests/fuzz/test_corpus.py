"""The fuzzers' seeds, given once: every condition of the fuzzers holds."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from workshop.build import build_targets

CORPUS = Path(__file__).with_name("corpus")


@pytest.mark.parametrize("fuzzer", ["call_sequence", "model_exchange", "state_bytes"])
def test_seeds(fuzzer: str) -> None:
    program = build_targets("default", [f"replay_{fuzzer}"]) / f"replay_{fuzzer}"
    seeds = sorted((CORPUS / fuzzer).iterdir())
    done = subprocess.run([program, *seeds], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"{len(seeds)} inputs\n"
