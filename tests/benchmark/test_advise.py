"""scripts/advise: the level it names is the cheapest within the accuracy, and its expected error is true."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from frictionlab.bench import advise
from frictionlab.bench.cases import Case, expected
from frictionlab.bench.driver import Bench
from frictionlab.bench.levels import cheapest, grade, scenes
from frictionlab.fmu import FrictionFmu, simulate
from frictionlab.parameters import PERIOD

SOFT = {"vibration.V_1": 1.44, "vibration.a_d": 1.1e-6, "contact.stiffnessScale": 4.353e-7}


def run(fmu_path: Path, capsys: pytest.CaptureFixture[str], *words: str) -> str:
    advise.main(["--quick", "--build-dir", str(fmu_path.parent), *words])
    return capsys.readouterr().out


@pytest.mark.usefixtures("bench")
def test_the_advice_can_be_pasted_and_keeps_its_word(
    fmu: FrictionFmu, fmu_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = run(fmu_path, capsys, "--accuracy", "1e-4", *(f"{name}={value}" for name, value in SOFT.items()))
    words = text[text.index("--start-values") :].split()[1:]
    settings = dict(zip(words[::2], words[1::2], strict=True))
    values = {name: _number(value) for name, value in settings.items()}
    promised = float(re.search(r"expected error (\S+) F_C", text)[1])  # type: ignore[index]

    rows = simulate(fmu, values, PERIOD, advise.COUNT)
    F, F_mean = expected(Case("scene", "", SOFT, PERIOD, advise.COUNT), 0.0)
    error = max(abs(rows["F_t"][1:] - F).max(), abs(rows["F_t_mean"][1:] - F_mean).max()) / 55.0
    assert error <= 1e-4
    assert error == pytest.approx(promised, rel=0.06, abs=1e-15)


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def test_the_cheapest_of_all_within_the_accuracy_is_taken(bench: Bench) -> None:
    graded = grade(bench, Case("soft", "", SOFT), quick=True)
    for accuracy in (1e-2, 1e-3, 1e-6):
        best = cheapest(graded, accuracy)
        assert best is not None and best.error() <= accuracy
        rivals = [g for g in graded if not g.point.failure and g.error() <= accuracy]
        assert all(best.point.cpu <= 1.1 * g.point.cpu for g in rivals)
    assert cheapest(graded, 1e-30) is None


@pytest.mark.parametrize("name", ["presliding", "stick-slip"])
def test_coulomb_fails_where_the_bristle_matters(bench: Bench, name: str) -> None:
    case = next(case for case in scenes() if case.name == name)
    coulomb = next(g for g in grade(bench, case, quick=True) if g.kind == "Coulomb")
    assert coulomb.error() > 0.1


def test_a_moving_separation_needs_the_asperities(bench: Bench) -> None:
    best = cheapest(grade(bench, Case("soft", "", SOFT), quick=True), 1e-2)
    assert best is not None and best.level.contact == "Asperities" and best.level.friction == "Dahl"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["V=fast"], "V: 'fast' is not a number"),
        (["V"], "V: is not of the form NAME=VALUE"),
        (["speed=1"], "speed does not describe a scene"),
        (["d=-1e-6"], "d = -1e-06 m is below its minimum"),
        (["contact.model=Soft"], "is not one of Asperities, Constant"),
        (["--accuracy", "0"], "--accuracy 0: must lie between"),
        (["--step", "-1"], "--step -1 s: must be a finite number above 0"),
        (["--inputs", "nowhere.csv"], "nowhere.csv: No such file"),
    ],
)
@pytest.mark.usefixtures("bench")
def test_bad_questions_get_one_line(
    fmu_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    with pytest.raises(SystemExit) as ended:
        run(fmu_path, capsys, *words)
    assert message in str(ended.value)
    assert str(ended.value).count("\n") == 0


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("time,V\n0,0.1\n1e-5,x\n", "line 3, V: 'x' is not a number"),
        ("time,V\n0,0.1\n1e-5,0.2\n3e-5,0.2\n", "time must grow in even steps"),
        ("t,V\n0,0.1\n1e-5,0.2\n", "needs a column time"),
        ("time,speed\n0,0.1\n1e-5,0.2\n", "at least one of V, d, E"),
    ],
)
@pytest.mark.usefixtures("bench")
def test_bad_inputs_are_told_by_their_line(
    fmu_path: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path, content: str, message: str
) -> None:
    path = tmp_path / "inputs.csv"
    path.write_text(content)
    with pytest.raises(SystemExit, match=re.escape(message)):
        run(fmu_path, capsys, "--inputs", str(path))


@pytest.mark.usefixtures("bench")
def test_inputs_from_a_file(fmu_path: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "inputs.csv"
    path.write_text("time,V\n" + "".join(f"{k * 1e-5},{0.01 * (k - 5)}\n" for k in range(11)))
    text = run(fmu_path, capsys, "--inputs", str(path), "--linear", "contact.stiffnessScale=1e-6")
    assert "communication step 1e-05 s, inputs linear" in text
