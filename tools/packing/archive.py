"""Packs an FMU: model description with its guid, binaries, sources and any further files.

The same input gives the same bytes: names are sorted and timestamps fixed.
"""

import argparse
import hashlib
import re
import struct
import sys
import zipfile
from pathlib import Path

from frictioncontact.files import whole_file
from tools.packing import model_description

FMI_HEADERS = ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h")
CHECKSUMS = "extra/org.fmi-standard.fmi-ls-ref/sha256sums.txt"
# ELF, PE, Mach-O, universal Mach-O
BINARY_BEGINNINGS = (b"\x7fELF", b"MZ", b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe")


def source_files(source_dir: Path, table: Path, fmi_headers: Path) -> dict[str, Path]:
    """What a C11 compiler needs to build the FMU alone: path under sources/ -> file."""
    files = {
        path.relative_to(source_dir).as_posix(): path
        for path in source_dir.rglob("*")
        if path.suffix in (".c", ".h")
    }
    files["fmi2/variables.c"] = table
    files |= {name: fmi_headers / name for name in FMI_HEADERS}
    return files


def whole_binary(path: Path) -> bytes:
    """The bytes of a shared library; ValueError if it is none, or was not written to its end."""
    content = path.read_bytes()
    if not content.startswith(BINARY_BEGINNINGS):
        raise ValueError(f"{path} is no shared library: remove it and build again")
    if content.startswith(b"\x7fELF\x02\x01"):  # little-endian, 64 bits: the section headers stand last
        header = content[:64].ljust(64, b"\xff")
        (offset,), (size, count) = struct.unpack_from("<Q", header, 40), struct.unpack_from("<HH", header, 58)
        if offset + size * count > len(content):
            raise ValueError(f"{path} is cut short: remove it and build again")
    return content


def packaged_xml(path: Path, sources: list[str]) -> bytes:
    """The model description as it goes into the FMU: with its guid and the list of its C sources."""
    xml = path.read_bytes()
    text, files = xml.decode(), "".join(f'      <File name="{name}"/>\n' for name in sources)
    for interface in ("ModelExchange", "CoSimulation"):
        listed = f">\n    <SourceFiles>\n{files}    </SourceFiles>\n  </{interface}>"
        text, count = re.subn(rf"(<{interface}\n[^<]*?)/>", rf"\1{listed}", text)
        if count != 1:
            raise ValueError(f"{path}: expected one {interface} element without content")
    guid = model_description.guid_of(xml)
    return text.replace(f'guid="{model_description.GUID_PLACEHOLDER}"', f'guid="{guid}"').encode()


def build_description(identifier: str, sources: list[str]) -> bytes:
    """sources/buildDescription.xml, which FMI 2.0.4 takes from FMI 3.0: what a compiler needs."""
    files = "".join(f'      <SourceFile name="{name}"/>\n' for name in sources)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{identifier}">
    <SourceFileSet language="C11">
{files}      <PreprocessorDefinition name="FC_NO_CVODE" value="1"/>
      <IncludeDirectory name="."/>
    </SourceFileSet>
  </BuildConfiguration>
</fmiBuildDescription>
""".encode()


def checksums(entries: dict[str, bytes]) -> bytes:
    """One line for each entry, as sha256sum writes and reads it."""
    lines = (f"{hashlib.sha256(entries[name]).hexdigest()}  {name}\n" for name in sorted(entries))
    return "".join(lines).encode()


def write_fmu(
    output: Path, xml: Path, binaries: dict[str, Path], sources: dict[str, Path], others: dict[str, Path]
) -> None:
    """Writes output whole or not at all.

    binaries maps platforms, sources paths under sources/, others paths in the FMU, to files.
    """
    identifier = model_description.read(xml).coSimulation.modelIdentifier
    c_files = sorted(name for name in sources if name.endswith(".c"))
    entries = {"modelDescription.xml": packaged_xml(xml, c_files)}
    for platform, path in binaries.items():
        entries[f"binaries/{platform}/{identifier}{path.suffix}"] = whole_binary(path)
    entries |= {f"sources/{name}": path.read_bytes() for name, path in sources.items()}
    entries["sources/buildDescription.xml"] = build_description(identifier, c_files)
    entries |= {name: path.read_bytes() for name, path in others.items()}
    entries[CHECKSUMS] = checksums(entries)
    with whole_file(output) as unfinished, zipfile.ZipFile(unfinished, "w") as archive:
        for name in sorted(entries, key=lambda name: (name != "modelDescription.xml", name)):
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.create_system = 3  # Unix, wherever it is packed
            info.external_attr = 0o100644 << 16
            archive.writestr(info, entries[name])


def _pair(text: str) -> tuple[str, Path]:
    name, separator, path = text.partition("=")
    if not separator:
        raise argparse.ArgumentTypeError(f"{text} is not of the form NAME=FILE")
    return name, Path(path)


def main() -> None:
    parser = argparse.ArgumentParser(
        description="Pack an FMU. @FILE stands for the arguments in FILE, one a line.",
        fromfile_prefix_chars="@",
    )
    parser.add_argument("output", type=Path)
    parser.add_argument("--xml", type=Path, required=True, help="modelDescription.xml with its placeholder")
    parser.add_argument("--sources", type=Path, required=True, help="folder of the C sources")
    parser.add_argument("--table", type=Path, required=True, help="generated variable table")
    parser.add_argument("--fmi-headers", type=Path, required=True, help="folder of the FMI headers")
    parser.add_argument("--binary", type=_pair, action="append", default=[], metavar="PLATFORM=FILE")
    parser.add_argument("--file", type=_pair, action="append", default=[], metavar="NAME=FILE")
    parser.add_argument("--folder", type=_pair, action="append", default=[], metavar="NAME=FOLDER")
    given = parser.parse_args()
    others = {f"{name}/{path.name}": path for name, folder in given.folder for path in folder.iterdir()}
    sources = source_files(given.sources, given.table, given.fmi_headers)
    write_fmu(given.output, given.xml, dict(given.binary), sources, others | dict(given.file))


if __name__ == "__main__":
    try:
        main()
    except (ValueError, OSError) as error:
        sys.exit(f"error: {error}")
