"""What a library shows to the loader, read from its file: format, processor, exports, needs, signature."""

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

import fmpy
import lief

from frictioncontact.errors import UserError
from tools.release.targets import PLATFORMS

lief.logging.disable()  # it reports on harmless oddities of the files

NEWEST_GLIBC = (2, 17)
# zig's linker exports the header and the handle of the image itself; nothing binds to them.
IMAGE_SYMBOLS = {"__mh_dylib_header", "___dso_handle"}
# Libraries that every system of the platform has.
SYSTEM_LIBRARIES = re.compile(
    r"lib(c|m|dl|pthread)\.so\.\d|ld-linux-.*|/usr/lib/libSystem\.B\.dylib|KERNEL32\.dll|api-ms-win-crt-.*\.dll|ntdll\.dll"
)
DEBUG = re.compile(r"\.symtab$|.*debug")  # sections
ADHOC_FLAG = 0x2


@dataclass(frozen=True)
class Library:
    """Facts of one shared library."""

    processor: str
    exports: set[str]
    needs: set[str]
    debug_sections: set[str]
    glibc: tuple[int, ...] = ()  # newest symbol version needed; empty where there is no glibc
    minimum_macos: tuple[int, ...] = ()
    signature: str = "none"  # or "ad hoc", "broken"


def inspect(path: Path) -> Library:
    binary, more = lief.parse(str(path)), {}
    if isinstance(binary, lief.ELF.Binary):
        processor, more["glibc"] = binary.header.machine_type, _newest_glibc(binary)
        exports, needs = (symbol.name for symbol in binary.exported_symbols), binary.libraries
    elif isinstance(binary, lief.PE.Binary):
        processor = binary.header.machine
        exports, needs = (function.name for function in binary.exported_functions), binary.libraries
    elif isinstance(binary, lief.MachO.Binary):
        processor, more["minimum_macos"] = binary.header.cpu_type, tuple(binary.build_version.minos)[:2]
        more["signature"] = _signature(binary, path.read_bytes())
        found = {str(entry.symbol.name) for entry in binary.dyld_info.exports if entry.symbol is not None}
        exports = (name.removeprefix("_") for name in found - IMAGE_SYMBOLS)
        own = lief.MachO.LoadCommand.TYPE.ID_DYLIB
        needs = (library.name for library in binary.libraries if library.command != own)
    else:
        raise UserError(f"{path} is no shared library")
    debug = {name for section in binary.sections if DEBUG.match(name := str(section.name))}
    name = str(processor).rpartition(".")[2]
    return Library(name, set(map(str, exports)), set(map(str, needs)), debug, **more)


def fmi2_functions() -> set[str]:
    """As the standard's header declares them."""
    declared = (Path(fmpy.__file__).parent / "c-code" / "fmi2Functions.h").read_text()
    return set(re.findall(r"FMI2_Export\s+fmi2\w+TYPE\s+(fmi2\w+)\s*;", declared))


def check(platform: str, path: Path, prefix: str = "fmi2") -> Library:
    """The facts of a library of the release; UserError names the first that is not as it must be.

    prefix: how the names begin that it exports.
    """
    library = inspect(path)
    wanted = PLATFORMS[platform]
    foreign = {name for name in library.exports if not name.startswith(prefix)}
    if foreign:
        raise UserError(f"{platform}: {sorted(foreign)[0]} is exported, and only {prefix} functions may be")
    if prefix == "fmi2" and (missing := fmi2_functions() - library.exports):
        raise UserError(f"{platform}: {sorted(missing)[0]} is not exported")
    if library.processor != wanted.processor:
        raise UserError(f"{platform}: built for {library.processor}, not for {wanted.processor}")
    if library.glibc > NEWEST_GLIBC:
        raise UserError(f"{platform}: needs GLIBC_{'.'.join(map(str, library.glibc))}, later than 2.17")
    strange = {name for name in library.needs if not SYSTEM_LIBRARIES.fullmatch(name)}
    if strange:
        raise UserError(f"{platform}: needs {sorted(strange)[0]}, which not every system has")
    if library.minimum_macos != wanted.macos:
        raise UserError(f"{platform}: minimum macOS is {library.minimum_macos}")
    if platform == "aarch64-darwin" and library.signature != "ad hoc":
        raise UserError(f"{platform}: signature: {library.signature}; macOS on ARM loads signed code only")
    if library.debug_sections:
        raise UserError(f"{platform}: not stripped, holds {sorted(library.debug_sections)[0]}")
    return library


def _newest_glibc(binary: lief.ELF.Binary) -> tuple[int, ...]:
    asked = (every for one in binary.symbols_version_requirement for every in one.get_auxiliary_symbols())
    found = (re.fullmatch(r"GLIBC_([\d.]+)", str(version.name)) for version in asked)
    return max((tuple(map(int, match[1].split("."))) for match in found if match), default=())


def _signature(binary: lief.MachO.Binary, content: bytes) -> str:
    """Reads the code directory and computes the hash of every page anew."""
    if not binary.has_code_signature:
        return "none"
    start = binary.code_signature.data_offset

    def number(offset: int, size: int = 4) -> int:
        return int.from_bytes(content[offset : offset + size], "big")

    if number(start) != 0xFADE0CC0:
        return "broken"
    slots = {number(start + 12 + 8 * k): number(start + 16 + 8 * k) for k in range(number(start + 8))}
    directory = start + slots.get(0, 0)
    if number(directory) != 0xFADE0C02:
        return "broken"
    flags, hashes, count, limit = (number(directory + offset) for offset in (12, 16, 28, 32))
    hash_size, page = content[directory + 36], 1 << content[directory + 39]
    for k in range(count):
        listed = content[directory + hashes + k * hash_size :][:hash_size]
        if hashlib.sha256(content[k * page : min((k + 1) * page, limit)]).digest()[:hash_size] != listed:
            return "broken"
    return "ad hoc" if flags & ADHOC_FLAG and limit == start else "broken"
