"""A host whose locale writes a decimal comma gets the same results and messages with a decimal point."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HOST = """
import locale, sys
from pathlib import Path
from fmi_library import Instance, Library
locale.setlocale(locale.LC_ALL, sys.argv[2])
assert locale.localeconv()["decimal_point"] == sys.argv[3]
with Instance(Library(Path(sys.argv[1]))) as instance:
    instance.set({"d": -1.5e-6})
    instance.set({"vibration.a_d": 20.5e-6})
    instance.call("fmi2EnterInitializationMode")
    instance.call("fmi2ExitInitializationMode")
    instance.set({"vibration.a_d": 1e-6, "vibration.V_1": 0.5})
    instance.call("fmi2ExitInitializationMode")
    instance.step(0.0, 1.5e-3)
    instance.step(0.25, 1.5e-3)
    print(*instance.get("F_t", "F_t_mean", "W_f", "sigma", "A_r", "delta"))
    print(*(message.text for message in instance.messages), sep="\\n")
"""


def run_host(folder: Path, name: str, decimal_point: str, locales: Path) -> list[str]:
    command = [sys.executable, "-c", HOST, str(folder), name, decimal_point]
    host = subprocess.run(
        command,
        cwd=Path(__file__).parent,  # where fmi_library is
        env={**os.environ, "LOCPATH": str(locales)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert host.returncode == 0, host.stderr
    return host.stdout.splitlines()


def test_decimal_comma(unzipped_fmu: Path, tmp_path: Path) -> None:
    localedef = shutil.which("localedef")
    made = tmp_path / "de_DE.UTF-8"
    if localedef:
        subprocess.run([localedef, "-i", "de_DE", "-f", "UTF-8", str(made)], capture_output=True, check=False)
    if not made.exists():
        pytest.skip("no locale with a decimal comma can be made here (localedef and its sources are missing)")
    german = run_host(unzipped_fmu, "de_DE.UTF-8", ",", tmp_path)
    plain = run_host(unzipped_fmu, "C", ".", tmp_path)
    assert german == plain
    assert "-1.5e-06 m" in german[1]
    assert len(german) == 5
