"""Sessions and arguments used wrongly: one line that names the mistake, and the instance as before."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Event, Thread

import pytest

import frictioncontact as fc
from frictioncontact.fmu import Session

SLOW = {"V": 0.5, "vibration.V_1": 1.44, "contact.stiffnessScale": 4.4e-7, "solver.method": "explicitEuler"}


@pytest.fixture
def session(fmu_path: Path) -> Iterator[Session]:
    with fc.FrictionFmu(fmu_path) as fmu, fmu.session({"V": 0.5}) as opened:
        yield opened


@pytest.mark.parametrize(
    "call",
    [
        lambda session: session.step(1e-3),
        lambda session: session.get("F_t"),
        lambda session: session.set("V", 1.0),
        lambda session: session.set_rates(V=1.0),
        lambda session: session.slope("F_t", "V"),
        lambda session: session.force_rate(),
        lambda session: session.save(),
        lambda session: session.restore((0.0, b"")),
    ],
)
def test_a_closed_session(session: Session, call: Callable[[Session], object]) -> None:
    session.close()
    session.close()
    with pytest.raises(fc.UserError, match=r"^this session is closed; open another one$"):
        call(session)


def test_a_closed_fmu(fmu_path: Path) -> None:
    fmu = fc.FrictionFmu(fmu_path)
    fmu.close()
    with pytest.raises(fc.UserError, match=f"^{re.escape(str(fmu_path))}: this FrictionFmu is closed; open"):
        fmu.session()


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, pickle.dumps])
def test_a_session_is_not_copied(session: Session, duplicate: Callable[[object], object]) -> None:
    with pytest.raises(fc.UserError, match=r"^a Session can't be copied or pickled; open another one$"):
        duplicate(session)


def test_a_copy_of_an_fmu_is_its_file_opened(session: Session) -> None:
    for again in (copy.copy(session.fmu), pickle.loads(pickle.dumps(session.fmu))):
        with again.session({"V": 0.5}) as other:
            assert other.get("V") == 0.5


def test_a_session_in_two_threads(fmu_path: Path) -> None:
    """While one steps, the call of the other is refused. Afterwards any thread may use the session."""
    with fc.FrictionFmu(fmu_path) as fmu, fmu.session(SLOW) as session:
        begun = Event()
        advance = session._advance

        def told(h: float) -> None:
            begun.set()
            advance(h)

        session._advance = told  # type: ignore[method-assign]
        thread = Thread(target=session.step, args=(0.1,))  # 1e7 steps of the solver
        thread.start()
        begun.wait()
        with pytest.raises(
            fc.UserError, match=r"^another thread uses this session; open one for each thread$"
        ):
            session.get("F_t")
        thread.join()
        assert session.time == 0.1 and session.get("F_t") != 0.0


def test_a_step_whose_length_is_no_number(session: Session) -> None:
    with pytest.raises(fc.UserError, match=r"^h = '1e-3' is not a number$"):
        session.step("1e-3")
    assert session.time == 0.0


@pytest.mark.parametrize(
    ("name", "message"),
    [(["V"], "set ['V']: ['V'] is no variable"), (None, "set None: None is no variable")],
)
def test_a_name_that_is_no_text(session: Session, name: str, message: str) -> None:
    with pytest.raises(fc.UserError, match=f"^{re.escape(message)}"):
        session.set(name, 1.0)


def test_a_session_says_what_it_is(session: Session, fmu_path: Path) -> None:
    session.step(1e-3)
    assert repr(session) == f"<session of {fmu_path.name}, at 0.001 s>"
    session.close()
    assert repr(session) == f"<session of {fmu_path.name}, closed>"


def test_an_unknown_name_is_said_of_the_call(session: Session) -> None:
    with pytest.raises(fc.UserError, match=r"^get: f_t is no variable of the FMU; did you mean F_t\?$"):
        session.get("f_t")


def test_a_path_or_a_contact_in_place_of_a_table() -> None:
    with pytest.raises(fc.UserError, match=r"^drive.csv: No such file"):
        fc.simulate(stop=1.0, step=1.0, inputs="drive.csv")
    with pytest.raises(fc.UserError, match=r"^data = 'steel-dry: .*or a pandas frame; it has one, .data$"):
        fc.identify(fc.contacts["steel-dry"], "contact.sigma")  # type: ignore[arg-type]


def test_contacts_show_their_list() -> None:
    assert repr(fc.contacts) == str(fc.contacts)
    assert repr(fc.contacts).splitlines()[0].startswith("steel-dry        40Cr steel on 40Cr steel")
