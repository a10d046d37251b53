"""Every library shows the fmi2 functions and nothing else, and runs on old systems; the check can tell."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import lief
import pytest

from frictioncontact.errors import UserError
from tools.release import inspect as release_inspect
from tools.release.inspect import Library, check, fmi2_functions, inspect
from tools.release.universal import universal
from tools.zig import environment, zig


def compiled(folder: Path, target: str, name: str) -> Path:
    """A small library for a target of zig's."""
    (folder / "source.c").write_text("int fmi2One(void) { return 1; }")
    command = [str(zig()), "cc", "-target", target, "-O1", "-shared", "-s", str(folder / "source.c"), "-o"]
    subprocess.run([*command, str(folder / name)], env=environment(), check=True)
    return folder / name


def test_linux_needs_an_old_glibc_only(library: Callable[[str], Path]) -> None:
    facts = inspect(library("linux64"))
    assert facts.exports == fmi2_functions() and len(fmi2_functions()) == 44
    named = re.findall(rb"\0GLIBC_(\d+)\.(\d+)", library("linux64").read_bytes())
    assert facts.glibc[:2] == max((int(major), int(minor)) for major, minor in named) <= (2, 17)
    assert facts.needs <= {"libc.so.6", "libm.so.6"}


def test_each_fault_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    sound = Library("X86_64", fmi2_functions(), {"libc.so.6"}, set(), (2, 14))
    for platform, change, message in (
        ("linux64", {"exports": {"fmi2DoStep"}}, "fmi2CancelStep is not exported"),
        ("linux64", {"exports": fmi2_functions() | {"CVode"}}, "linux64: CVode is exported"),
        ("aarch64-linux", {}, "built for X86_64, not for AARCH64"),
        ("linux64", {"glibc": (2, 29)}, r"needs GLIBC_2\.29, later than 2\.17"),
        ("linux64", {"needs": {"libsundials_cvode.so.6"}}, "needs libsundials_cvode.so.6"),
        ("linux64", {"debug_sections": {".symtab"}}, "not stripped"),
        ("darwin64", {"minimum_macos": (13, 0)}, "minimum macOS"),
        ("aarch64-darwin", {"processor": "ARM64", "minimum_macos": (11, 0)}, "signature: none"),
    ):
        monkeypatch.setattr(release_inspect, "inspect", lambda path, c=change: replace(sound, **c))
        with pytest.raises(UserError, match=message):
            check(platform, Path("FrictionContact.so"))


def test_a_damaged_signature_is_found(tmp_path: Path) -> None:
    """Apple's loader refuses a page whose hash differs from the signature's."""
    path = compiled(tmp_path, "aarch64-macos.11.0", "small.dylib")
    assert inspect(path).signature == "ad hoc"
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 1
    damaged = tmp_path / "damaged.dylib"
    damaged.write_bytes(content)
    assert inspect(damaged).signature == "broken"


def test_a_universal_library_holds_both(tmp_path: Path) -> None:
    targets = ("x86_64-macos.10.15", "aarch64-macos.11.0")
    slices = [compiled(tmp_path, target, f"{target}.dylib").read_bytes() for target in targets]
    fat = universal(slices)
    parsed = lief.MachO.parse(list(fat))
    for k, cpu in enumerate(("X86_64", "ARM64")):
        inside = parsed.at(k)
        assert inside.header.cpu_type.name == cpu and inside.fat_offset % (1 << 14) == 0
        assert fat[inside.fat_offset :].startswith(slices[k])
