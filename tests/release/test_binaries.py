"""Every library shows the fmi2 functions and nothing else, and runs on old systems; the check can tell."""

from __future__ import annotations

import re
import struct
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import fmpy
import pytest

from frictioncontact.errors import UserError
from workshop.release import inspect as release_inspect
from workshop.release.inspect import Library, check, inspect
from workshop.release.targets import environment, zig
from workshop.release.universal import universal

PLATFORMS = [
    "linux64",
    "aarch64-linux",
    "darwin64",
    "aarch64-darwin",
    pytest.param("win64", marks=pytest.mark.slow),
]


def fmi2_functions() -> set[str]:
    """As the standard's header declares them."""
    declared = (Path(fmpy.__file__).parent / "c-code" / "fmi2Functions.h").read_text()
    return set(re.findall(r"FMI2_Export\s+fmi2\w+TYPE\s+(fmi2\w+)\s*;", declared))


@pytest.mark.parametrize("platform", PLATFORMS)
def test_library(library: Callable[[str], Path], platform: str) -> None:
    facts = check(platform, library(platform))
    assert len(fmi2_functions()) == 44
    assert facts.exports == fmi2_functions()


def test_linux_needs_an_old_glibc_only(library: Callable[[str], Path]) -> None:
    facts = inspect(library("linux64"))
    named = re.findall(rb"\0GLIBC_(\d+)\.(\d+)", library("linux64").read_bytes())
    assert facts.glibc[:2] == max((int(major), int(minor)) for major, minor in named) <= (2, 17)
    assert facts.needs <= {"libc.so.6", "libm.so.6"}


def test_a_foreign_export_is_found(tmp_path: Path) -> None:
    source = tmp_path / "foreign.c"
    source.write_text("int fmi2One(void) { return 1; } int CVode(void) { return 2; }")
    compiler = [str(zig()), "cc", "-target", "x86_64-linux-gnu.2.17", "-shared", "-s"]
    command = [*compiler, str(source), "-o", str(tmp_path / "foreign.so")]
    subprocess.run(command, env=environment(), check=True)
    with pytest.raises(UserError, match="linux64: CVode is exported"):
        check("linux64", tmp_path / "foreign.so")


@pytest.mark.parametrize(
    ("platform", "change", "message"),
    [
        ("aarch64-linux", {}, "built for X86_64, not for AARCH64"),
        ("linux64", {"glibc": (2, 29)}, r"needs GLIBC_2\.29, later than 2\.17"),
        ("linux64", {"needs": {"libsundials_cvode.so.6"}}, "needs libsundials_cvode.so.6"),
        ("linux64", {"debug_sections": {".symtab"}}, "not stripped"),
        ("darwin64", {"minimum_macos": (13, 0)}, "minimum macOS"),
        ("aarch64-darwin", {"processor": "ARM64", "minimum_macos": (11, 0)}, "signature: none"),
    ],
)
def test_each_fault_is_found(
    monkeypatch: pytest.MonkeyPatch, platform: str, change: dict[str, object], message: str
) -> None:
    sound = Library("X86_64", {"fmi2DoStep"}, {"libc.so.6"}, (2, 14), (), "none", set())
    monkeypatch.setattr(release_inspect, "inspect", lambda path: replace(sound, **change))
    with pytest.raises(UserError, match=message):
        check(platform, Path("FrictionContact.so"))


def test_a_damaged_signature_is_found(library: Callable[[str], Path], tmp_path: Path) -> None:
    """Apple's loader refuses a page whose hash differs from the signature's."""
    path = library("aarch64-darwin")
    assert inspect(path).signature == "ad hoc"
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 1
    damaged = tmp_path / "damaged.dylib"
    damaged.write_bytes(content)
    assert inspect(damaged).signature == "broken"


def test_a_universal_library_holds_both(library: Callable[[str], Path]) -> None:
    slices = [library(platform).read_bytes() for platform in ("darwin64", "aarch64-darwin")]
    fat = universal(slices)
    magic, count = struct.unpack_from(">II", fat)
    assert (magic, count) == (0xCAFEBABE, 2)
    for k, (expected, processor) in enumerate(zip(slices, (0x01000007, 0x0100000C), strict=True)):
        cpu, _, offset, size, alignment = struct.unpack_from(">iiIII", fat, 8 + 20 * k)
        assert cpu == processor
        assert offset % (1 << alignment) == 0
        assert fat[offset : offset + size] == expected
