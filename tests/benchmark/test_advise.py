"""scripts/advise: what it recommends holds its promise, in scenes drawn at random and for every law."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from frictioncontact import simulation as simulate
from frictioncontact.advice import command as advise
from frictioncontact.advice.answer import advise as question
from frictioncontact.advice.coulomb_bound import coulomb_errors
from frictioncontact.command import main
from frictioncontact.errors import UserError
from frictioncontact.fmu import FrictionFmu, Value
from frictioncontact.parameters import PERIOD, STIFFNESS_PRINTED
from tools.bench.cases import Case
from tools.bench.levels import largest_errors, runs_of
from tools.reference import changed, scene_of, settled, start_values, step

F_C = 55.0  # N
LAWS = ("Dahl", "LuGre", "ElasticPlastic", "Coulomb")


def draw(seed: int) -> tuple[dict[str, Value], float, float]:
    """Start values of a scene, accuracy, communication step [s]."""
    random = np.random.default_rng(seed)
    values: dict[str, Value] = {
        "V": 10.0 ** random.uniform(-3, 0),
        "contact.stiffnessScale": 10.0 ** random.uniform(2, 13) / STIFFNESS_PRINTED,
        "friction.model": LAWS[seed % 4],
        "friction.staticRatio": 1.0 if LAWS[seed % 4] == "ElasticPlastic" else random.uniform(1, 2),
        "friction.V_S": 10.0 ** random.uniform(-3, -1),
        "vibration.V_1": random.choice([0.0, 1.0, 1.0]) * 10.0 ** random.uniform(-2, 0.5),
        "vibration.a_d": random.choice([0.0, 1.0, 1.0]) * random.uniform(0.1e-6, 1.1e-6),
        "vibration.phase_d": random.uniform(0, 6),
    }
    return values, 10.0 ** random.uniform(-5, -2), PERIOD * 10.0 ** random.uniform(-1, 1.5)


def missed(
    fmu: FrictionFmu,
    scene: Mapping[str, Value],
    settings: Mapping[str, Value],
    step: float,
    phases: tuple[float, ...] = (0.0, 0.5),
) -> np.ndarray:
    """The largest errors of F_t and F_t_mean [N] in some steps from some phases, from rest and settled."""
    case = Case("drawn", "drawn", scene, step)
    return largest_errors(fmu, case, settings, runs_of(case, phases))


def allowed(scene: Mapping[str, Value], accuracy: float) -> float:
    """The largest error [N] that the promise grants: of F_C, and of a mean friction that is not nearly 0."""
    truth = scene_of(scene)
    mean = abs(settled(truth)[0]) if truth.vibrates else F_C
    return accuracy * (min(F_C, mean) if mean > 1e-4 else F_C)


Advised = Callable[..., dict[str, float]]


@pytest.fixture
def advised(fmu_path: Path, capsys: pytest.CaptureFixture[str]) -> Advised:
    """The start values that the command prints for fmpy, which takes numbers alone."""

    def advise_with(*words: str) -> dict[str, float]:
        words = tuple(word if "=" not in word else f"--set={word}" for word in words)
        main(advise, ["--quick", "--fmu", str(fmu_path), *words])
        text = capsys.readouterr().out
        pairs = text[text.index("--start-values") :].split()[1:]
        return {name: float(value) for name, value in zip(pairs[::2], pairs[1::2], strict=True)}

    return advise_with


OPEN = ["contact.input=Load", "load=0"]
SEEDS = (0, 1, 3, 26)  # one of ElasticPlastic, whose reference takes longest


@pytest.mark.parametrize("seed", SEEDS)
def test_the_advice_holds_its_promise(fmu: FrictionFmu, advised: Advised, seed: int) -> None:
    scene, accuracy, step = draw(seed)
    words = [f"{name}={value}" for name, value in scene.items()]
    settings = advised("--accuracy", repr(accuracy), "--step", repr(step), *words)
    assert missed(fmu, scene, settings, step).max() <= allowed(scene, accuracy)


def test_coulomb_is_advised_where_it_is_close_enough(fmu: FrictionFmu, advised: Advised) -> None:
    for words, outputs in (
        (["V=0.5"], [0, 1]),
        (["V=0.7", "vibration.V_1=1.44", "--output-of", "F_t_mean"], [1]),
    ):
        settings = advised("--accuracy", "1e-2", "--step", "1e-3", *words)
        assert settings["friction.model"] == 2.0
        scene = {k: v for k, v in settings.items() if k != "friction.model"}
        assert missed(fmu, scene, settings, 1e-3)[outputs].max() <= allowed(scene, 1e-2)


def test_the_promise_is_of_F_C_if_viscous_friction_is_far_larger(fmu: FrictionFmu, advised: Advised) -> None:
    """solver.tolerance is relative to sigma_2 |V|, 100 F_C here."""
    scene: dict[str, Value] = {"V": 0.4652, "vibration.V_1": 0.3, "friction.model": "LuGre"}
    scene |= {"contact.model": "Constant", "contact.sigma": 1.034e8}
    scene |= {"friction.sigma_1": 18.17, "friction.sigma_2": 7369.0}
    words = [f"{name}={value}" for name, value in scene.items()]
    settings = advised("--accuracy", "1e-3", "--step", "1.3e-5", *words)
    assert missed(fmu, scene, settings, 1.3e-5, (0.6, 0.8)).max() <= 1e-3 * F_C
    with pytest.raises(SystemExit, match=r"accuracy 1e-08: must be at least 1\.02e-06 here"):
        advised("--accuracy", "1e-8", *words)


@pytest.mark.parametrize("seed", range(12))
def test_no_bristle_is_farther_from_coulomb_than_the_bound(seed: int) -> None:
    random = np.random.default_rng(seed)
    V_1 = 10.0 ** random.uniform(-2, 0.5)
    V = V_1 * random.choice([random.uniform(-1, 1), random.uniform(0.9, 1), random.uniform(1.001, 3)])
    sigma = 10.0 ** random.uniform(5, 12)
    values = {"V": V, "vibration.V_1": V_1, "contact.model": "Constant", "contact.sigma": sigma}
    h, start = PERIOD * random.uniform(0.1, 5), PERIOD * random.uniform(0, 1)
    scene = changed(scene_of(values), h=h, start=start)
    bounds = coulomb_errors(start_values(scene), sigma, h)
    rigid = step(changed(scene, law="Coulomb"))
    for delta_0 in (0.0, 55.0 / sigma, -55.0 / sigma):
        found = step(changed(scene, delta_0=delta_0))
        assert abs(found.F_t - rigid.F_t) / 55.0 <= bounds[0] + 1e-14
        assert abs(found.F_t_mean - rigid.F_t_mean) / 55.0 <= bounds[1] + 1e-14


def test_bad_questions_get_one_line(fmu_path: Path, advised: Advised, tmp_path: Path) -> None:
    uneven = tmp_path / "inputs.csv"
    uneven.write_text("time,V\n0,0.1\n1e-5,0.2\n3e-5,0.2\n")
    mass = ["--mass", "1", "--step", "1e-3"]
    for words, message in (
        (["solver.tolerance=1e-3"], "solver.tolerance does not describe a scene; these do: V, d, E"),
        (["--accuracy", "0"], "accuracy 0: must lie between"),
        (["--step", "-1"], "step -1 s: must lie between"),
        (["--inputs", str(uneven)], "inputs: time must grow in even steps, and does not at sample "),
        ([*OPEN, "friction.limit=Load"], "friction.mu F_n = 0 N: must be above 0 N"),
        ([*OPEN, *mass], "mass: sigma = 0 N/m: must be above 0 N/m"),
        (["--mass", "0", "--step", "1e-4"], "mass 0 kg: must lie between"),
        (["--mass", "1"], "mass needs step and takes no inputs"),
        ([*mass, "friction.model=Coulomb"], "Coulomb never sticks"),
    ):
        with pytest.raises(SystemExit) as ended:
            advised(*words)
        assert message in str(ended.value) and "\n" not in str(ended.value)
    with pytest.raises(UserError, match=r"^master = 'Gauss': must be one of 'Jacobi', "):
        question({}, mass=1.0, step=1e-4, master="Gauss", fmu=fmu_path)


TIMES, SPEEDS = 2e-5 + 1e-5 * np.arange(11), 0.01 * (np.arange(11) - 5)


def test_the_command_that_it_prints_holds_the_inputs_of_a_file(
    fmu: FrictionFmu, fmu_path: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """It gives what steps do from the first time on; of linear inputs, frictioncontact's; else none."""

    def words(heading: str, begin: float, *options: str) -> list[str]:
        path = tmp_path / "inputs.csv"
        table = np.column_stack([TIMES - TIMES[0] + begin, SPEEDS])
        np.savetxt(path, table, "%.17g", delimiter=",", header=heading, comments="")
        soft = ["--set", "contact.stiffnessScale=1e-6", "--fmu", str(fmu_path)]
        main(advise, ["--quick", "--inputs", str(path), *soft, *options])
        return capsys.readouterr().out.splitlines()[-1].split()

    printed = words("time,V", TIMES[0])
    assert printed[:2] == ["fmpy", "simulate"]
    out = ["--output-variables", "F_t", "--output-file", str(tmp_path / "out.csv")]
    run = [sys.executable, "-m", "fmpy", "simulate", str(fmu_path), *out, *printed[3:]]
    subprocess.run(run, check=True, capture_output=True, timeout=60)
    found = np.loadtxt(tmp_path / "out.csv", delimiter=",", skiprows=1)
    with fmu.session({"contact.stiffnessScale": 1e-6, "V": SPEEDS[0]}, start=TIMES[0]) as session:
        for k, V in enumerate(SPEEDS[:-1]):
            session.set("V", V)
            session.step(1e-5)
            assert found[k + 1] == pytest.approx([TIMES[k + 1], session.get("F_t")], rel=1e-3)
    printed = words("time [s],V [m/s]", 0.0, "--linear")
    assert printed[:2] == ["frictioncontact", "simulate"]
    main(simulate, printed[2:])
    assert len(capsys.readouterr().out.splitlines()) == len(TIMES) + 1
    for heading, begin, options in (("time [ms],V", 0.0, []), ("time,V", 1e-5, ["--linear"])):
        assert words(heading, begin, *options)[:2] == ["Neither", "fmpy"]
