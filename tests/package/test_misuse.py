"""Sessions and arguments used wrongly: one line that names the mistake, and the instance as before."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Iterator
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


def test_what_is_closed(session: Session, fmu_path: Path) -> None:
    session.close()
    session.close()
    for call in (
        lambda: session.step(1e-3),
        lambda: session.get("F_t"),
        lambda: session.set("V", 1.0),
        lambda: session.set_rates(V=1.0),
        lambda: session.slope("F_t", "V"),
        lambda: session.force_rate(),
        lambda: session.save(),
        lambda: session.restore((0.0, b"")),
    ):
        with pytest.raises(fc.UserError, match=r"^this session is closed; open another one$"):
            call()
    fmu = fc.FrictionFmu(fmu_path)
    fmu.close()
    with pytest.raises(fc.UserError, match=f"^{re.escape(str(fmu_path))}: this FrictionFmu is closed; open"):
        fmu.session()


def test_a_session_is_not_copied(session: Session) -> None:
    for duplicate in (copy.copy, copy.deepcopy, pickle.dumps):
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


def test_a_session_says_what_it_is(session: Session, fmu_path: Path) -> None:
    session.step(1e-3)
    assert repr(session) == f"<session of {fmu_path.name}, at 0.001 s>"
    session.close()
    assert repr(session) == f"<session of {fmu_path.name}, closed>"


def test_a_contact_in_place_of_a_table_or_a_scene() -> None:
    with pytest.raises(fc.UserError, match=r"^data = 'steel-dry: .*or a pandas frame; it has one, .data$"):
        fc.identify(fc.contacts["steel-dry"], "contact.sigma")  # type: ignore[arg-type]
    with pytest.raises(fc.UserError, match=r"^scene = 'steel-dry: 40Cr.*; it has one, .start$"):
        fc.friction_law(fc.contacts["steel-dry"])  # type: ignore[arg-type]


def test_contacts_show_their_list() -> None:
    assert repr(fc.contacts) == str(fc.contacts)
    assert repr(fc.contacts).splitlines()[0].startswith("steel-dry        40Cr steel on 40Cr steel")
