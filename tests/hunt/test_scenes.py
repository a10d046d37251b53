"""A short hunt finds nothing, and what hunts found stays found: every sequence holds what is promised."""

from __future__ import annotations

import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

from tools import description
from tools.build import build_targets
from tools.project import ROOT

WHERE = "tolerance=1e-06 law=LuGre"
SCENES = Path(__file__).with_name("scenes.txt")
# Evaluations a sequence: the plan of panels decides them. Without optimization they are nearly the same:
# near a line rounding decides a few events.
WORK = {"line": 36.451, "plane": 391.57, "found": 360.84}


@cache
def program() -> str:
    return str(build_targets("default", ["hunt"]) / "hunt/hunt")


def hunt(*options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([program(), *options], capture_output=True, text=True, check=False)


def assert_work(done: subprocess.CompletedProcess[str], kind: str) -> None:
    work = float(done.stdout.split()[-4])
    assert work == pytest.approx(WORK[kind], rel=1e-3), "more or less work: say why, and renew WORK"


@pytest.mark.parametrize(("count", "kind"), [("200", "line"), ("24", "plane"), ("40", "mass")])
def test_the_first_sequences_of_the_hunts_on_the_page(count: str, kind: str) -> None:
    """Of docs/reliability.md: every law, contact, limit, jumps; leaps in the plane; its limit; a mass."""
    done = hunt("--seed", "204", "--scenes", count, *([] if kind == "line" else [f"--{kind}"]))
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"\n{count} sequences of " in done.stdout and " 0 refused" in done.stdout
    assert kind == "plane" or " 0 beyond the reference" in done.stdout  # some are
    if kind in WORK:
        assert_work(done, kind)


@pytest.mark.parametrize(
    ("trials", "options"),
    [(200, ()), (100, ("--where", WHERE)), (20, ("--plane",))],
)
def test_a_climb_finds_no_miss(trials: int, options: tuple[str, ...]) -> None:
    """Its result depends on the seed alone, and can be replayed."""
    done, again = (hunt("--climb", "1e9", "--seed", "5", "--scenes", str(trials), *options) for _ in range(2))
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout == again.stdout and f"\n{trials} sequences of " in done.stdout
    assert done.stdout.startswith("worst ratio=")
    worst = done.stdout.splitlines()[0].partition(": ")[2]
    replayed = [float(text.split()[0]) for text in hunt("--replay", worst).stdout.split(": ratio ")[1:]]
    assert max(replayed) >= 0.99 * float(done.stdout[12:].split(":")[0])  # F_t_settled is judged, too
    assert all(word in worst for word in WHERE.split()) == ("--where" in options)


def test_masses_that_were_found() -> None:
    """Rests at a step's end and under a fast V, touches of w = 0, dampers, panels that cannot be solved."""
    done = hunt("--file", str(SCENES.with_name("masses.txt")))
    assert done.returncode == 0, done.stdout + done.stderr
    assert " 0 refused, 0 beyond the reference, 0 misses" in done.stdout


def test_scenes_that_were_found() -> None:
    done = hunt("--file", str(SCENES))
    assert done.returncode == 0, done.stdout + done.stderr
    count = sum(line.startswith("tolerance=") for line in SCENES.read_text().splitlines())
    assert f"\n{count} sequences of " in done.stdout
    assert " 0 refused, 0 beyond the reference, 0 misses" in done.stdout
    assert_work(done, "found")


def test_a_miss_is_told_and_made_plain() -> None:
    """Explicit Euler is far from a tolerance of 1e-8, also in a second step."""
    scene = "tolerance=1e-8 law=Dahl V_1=0.3 stiffnessScale=1e-6 h=3e-5 then F_C=30"
    replay = ("--minimize", "1", "--replay")
    done = hunt(*replay, "method=6 " + scene)
    assert "miss law=Dahl" in done.stdout and "step=2" in done.stdout, done.stdout
    assert "plain: tolerance=1e-08 method=6" in done.stdout, done.stdout
    found = hunt(*replay, scene).stdout
    assert "miss" not in found and found.count("ratio") == 2


def test_what_is_no_scene_is_refused() -> None:
    for word in ("v=1", "law=Stribeck", "V=fast"):
        done = hunt("--replay", word)
        assert done.returncode == 2 and f"{word.split('=')[0]}" in done.stderr


def test_the_reference_has_every_input_and_parameter() -> None:
    """Each but those of the solver is a field of a scene, which scenes.c draws."""
    drawn = (ROOT / "hunt/scenes.c").read_text(encoding="utf-8")
    header = (ROOT / "hunt/reference.h").read_text(encoding="utf-8")
    fields = {variable: field for field, variable in re.findall(r"X\((\w+), ([\w.]+)\)", header)}
    wanted = {
        each.name
        for each in description.read().modelVariables
        if each.causality in ("input", "parameter") and not each.name.startswith("solver.")
    }
    assert wanted - fields.keys() == set(), "hunt/reference.h lacks them"
    is_set = r"&s(->|\.){0}\b|\bs(->|\.){0} \*?=[^=]"
    never = {name for name in wanted if not re.search(is_set.format(fields[name]), drawn)}
    assert never == set(), "hunt/scenes.c does not draw them"
