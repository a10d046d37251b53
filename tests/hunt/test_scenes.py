"""What a hunt found stays found: every sequence of scenes.txt holds what is promised."""

from __future__ import annotations

import subprocess
from pathlib import Path

from workshop.build import build_targets
from workshop.check.command import write_hunt_corpus
from workshop.project import ROOT

SCENES = Path(__file__).with_name("scenes.txt")


def hunt(*options: str) -> subprocess.CompletedProcess[str]:
    program = build_targets("default", ["hunt"]) / "hunt/hunt"
    return subprocess.run([str(program), *options], capture_output=True, text=True, check=False)


def test_scenes_that_were_found() -> None:
    done = hunt("--file", str(SCENES))
    assert done.returncode == 0, done.stdout + done.stderr
    count = sum(line.startswith("tolerance=") for line in SCENES.read_text().splitlines())
    assert f"{count} sequences drawn, 0 refused or too dear, 0 misses" in done.stdout


def test_the_corpus_of_the_guided_hunt(tmp_path: Path) -> None:
    """Sequences that together go every way through the solver that libFuzzer found."""
    program = build_targets("default", ["replay_hunt"]) / "hunt/replay_hunt"
    sequences = write_hunt_corpus(tmp_path)
    done = subprocess.run([str(program), *sequences], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout == f"{len(sequences)} inputs\n"


def test_a_miss_is_told_and_made_plain() -> None:
    """Explicit Euler is far from a tolerance of 1e-9, also in a second step."""
    scene = "law=Dahl V_1=0.3 stiffnessScale=1e-6 h=3e-5 then F_C=30"
    replay = ("--tolerance", "1e-9", "--minimize", "1", "--replay", "method=explicitEuler " + scene)
    done = hunt("--strict", *replay)
    assert "miss class=fixed steps; cvode by decades law=Dahl" in done.stdout and "step=2" in done.stdout, (
        done.stdout
    )
    assert done.stdout.count("plain: tolerance=1e-09 method=explicitEuler") == 1, done.stdout
    assert "miss" not in hunt(*replay).stdout
    assert hunt("--replay", scene).stdout.count("ratio") == 10


def test_the_page_promises_what_the_hunt_grants() -> None:
    page = (ROOT / "docs/numerics.md").read_text().splitlines()
    rows = hunt("--promise").stdout.splitlines()
    first = next(number for number, line in enumerate(page) if line.startswith(rows[0]))
    table = [line for line in page[first:] if line.startswith("|") and not line.startswith("|---")]
    table = table[: len(rows)]
    assert len(rows) == 4
    for line, row in zip(table, rows, strict=True):
        assert line.startswith(row)
    assert page[first + len(rows) + 1] == "", "the page has a row more"


def test_what_is_no_scene_is_refused() -> None:
    for word in ("v=1", "law=Stribeck", "V=fast"):
        done = hunt("--replay", word)
        assert done.returncode == 2 and f"{word.split('=')[0]}" in done.stderr
