"""Sessions used wrongly: one line that names the mistake, and the instance as before."""

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
    session.step(1e-3)
    assert repr(session) == f"<session of {fmu_path.name}, at 0.001 s>"
    session.close()
    session.close()
    assert repr(session) == f"<session of {fmu_path.name}, closed>"
    calls = [session.force_rate, session.save, lambda: session.get("F_t"), lambda: session.set("V", 1.0)]
    calls += [lambda: session.step(1e-3), lambda: session.set_rates(V=1.0), lambda: session.slope("F_t", "V")]
    for call in (*calls, lambda: session.restore((0.0, b""))):
        with pytest.raises(fc.UserError, match=r"^this session is closed; open another one$"):
            call()
    session.fmu.close()
    with pytest.raises(fc.UserError, match=f"^{re.escape(str(fmu_path))}: this FrictionFmu is closed; open"):
        session.fmu.session()


def test_copies(session: Session) -> None:
    for duplicate in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(fc.UserError, match=r"^a Session can't be copied or pickled; open another one$"):
            duplicate(session)
    again = pickle.loads(pickle.dumps(session.fmu))  # its file, opened
    with again.session({"V": 0.5}) as other:
        assert other.get("V") == 0.5


def test_a_session_in_two_threads(fmu_path: Path) -> None:
    """While one steps, the call of the other is refused. Afterwards any thread may use the session."""
    with fc.FrictionFmu(fmu_path) as fmu, fmu.session(SLOW) as session:
        begun, advance = Event(), session._advance

        def told(h: float) -> None:
            begun.set()
            advance(h)

        session._advance = told  # type: ignore[method-assign]
        thread = Thread(target=session.step, args=(0.014,))  # 1.4e6 steps of the solver
        thread.start()
        begun.wait()
        message = r"^another thread uses this session; open one for each thread$"
        with pytest.raises(fc.UserError, match=message):
            session.get("F_t")
        thread.join()
        assert session.time == 0.014 and session.get("F_t") != 0.0


def test_a_contact_in_place_of_a_table_or_a_scene() -> None:
    steel = fc.contacts["steel-dry"]
    with pytest.raises(fc.UserError, match=r"^data = 'steel-dry: .*or a pandas frame; it has one, .data$"):
        fc.identify(steel, "contact.sigma")  # type: ignore[arg-type]
    with pytest.raises(fc.UserError, match=r"^scene = 'steel-dry: 40Cr.*; it has one, .start$"):
        fc.friction_law(steel)  # type: ignore[arg-type]
    assert repr(fc.contacts) == str(fc.contacts)
    assert repr(fc.contacts).splitlines()[0].startswith("steel-dry        40Cr steel on 40Cr steel")
