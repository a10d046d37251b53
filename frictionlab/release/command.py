"""One .fmu that runs everywhere: `scripts/release`.

Every library is compiled by zig from the same sources, with SUNDIALS CVODE inside, then inspected. The file
appears under its name only when it is complete and the FMI validator finds nothing. The same input gives the
same bytes.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.metadata
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterable
from pathlib import Path

import fmpy
from fmpy.validation import validate_fmu
from rich.progress import Progress

from frictionlab.project import ROOT

sys.path.insert(0, str(ROOT / "cmake"))

import generate_variables
import model_description
import package_fmu

from frictionlab.command import progress_bar
from frictionlab.fmu_docs import page as fmu_documentation
from frictionlab.release import inspect as release_inspect
from frictionlab.release.sundials import SundialsSource, fetched
from frictionlab.release.targets import TARGETS, ReleaseError, compile_library, zig
from frictionlab.release.universal import universal

QUICK = ("linux64", "aarch64-linux")
SUNDIALS = ROOT / "build" / "sundials-source"
CACHE = ROOT / "build" / "zig-cache"
# Parts of the compiler's run-time library are linked into every binary, of MinGW-w64's into that of Windows.
TOOLCHAIN_LICENSES = {
    "zig-license.txt": "LICENSE",
    "mingw-w64-license.txt": "lib/libc/mingw/COPYING",
}


def fmi_headers() -> Path:
    return Path(fmpy.__file__).parent / "c-code"


def compile_platforms(
    platforms: Iterable[str],
    folder: Path,
    sundials: SundialsSource,
    cache: Path = CACHE,
    root: Path = ROOT,
    tell: Callable[[str], None] = lambda platform: None,
) -> dict[str, Path]:
    """Libraries under folder, one a platform, each inspected; root holds the sources."""
    table = folder / "variables.c"
    table.write_text(generate_variables.table(model_description.read(root / "modelDescription.xml")))
    sources = [
        *sorted((root / "fmu_src").rglob("*.c")),
        table,
    ]
    includes = [root / "fmu_src", fmi_headers(), *sundials.includes]
    libraries = {}
    for platform in platforms:
        tell(platform)
        (folder / platform).mkdir()
        libraries[platform] = compile_library(
            TARGETS[platform],
            [*sources, *sundials.sources],
            includes,
            root / "cmake" / "exports.map",
            cache,
            folder / platform,
        )
        release_inspect.check(platform, libraries[platform])
    return libraries


def with_universal_darwin(libraries: dict[str, Path], folder: Path) -> dict[str, Path]:
    """darwin64 for both processors, where both were compiled."""
    if not {"darwin64", "aarch64-darwin"} <= libraries.keys():
        return libraries
    path = folder / "universal.dylib"
    path.write_bytes(
        universal([libraries["darwin64"].read_bytes(), libraries["aarch64-darwin"].read_bytes()])
    )
    return {**libraries, "darwin64": path}


def pack(
    output: Path, libraries: dict[str, Path], table: Path, sundials: SundialsSource, folder: Path
) -> None:
    """Writes output, if the validator finds nothing in it; folder is scratch."""
    page = folder / "index.html"
    page.write_text(fmu_documentation.page(ROOT / "modelDescription.xml"), encoding="utf-8")
    others = fmu_documentation.files(page)
    others |= {
        f"documentation/licenses/{name}": zig().parent / path for name, path in TOOLCHAIN_LICENSES.items()
    }
    unchecked = output.with_name(f".{output.stem}.unchecked.fmu")
    try:
        package_fmu.write_fmu(
            unchecked,
            ROOT / "modelDescription.xml",
            libraries,
            package_fmu.source_files(ROOT / "fmu_src", table, fmi_headers()),
            others,
        )
        problems = validate_fmu(str(unchecked))
        if problems:
            raise ReleaseError(f"the validator finds: {' '.join(problems[0].split())}")
        unchecked.replace(output)
    finally:
        unchecked.unlink(missing_ok=True)


def size_table(fmu: Path) -> str:
    """Sizes of the parts of the file, unpacked and packed, in kB of 1000 bytes."""
    groups: dict[str, list[int]] = {}
    with zipfile.ZipFile(fmu) as archive:
        for entry in archive.infolist():
            top, _, rest = entry.filename.partition("/")
            group = f"{top}/{rest.partition('/')[0]}" if top == "binaries" else f"{top}/" if rest else top
            sizes = groups.setdefault(group, [0, 0])
            sizes[0] += entry.file_size
            sizes[1] += entry.compress_size
    rows = [(group, whole, packed) for group, (whole, packed) in groups.items()]
    rows.append((fmu.name, sum(whole for _, whole, _ in rows), fmu.stat().st_size))
    lines = [f"{'part':26}{'unpacked kB':>12}{'packed kB':>12}"]
    lines += [f"{name:26}{whole / 1e3:12.1f}{packed / 1e3:12.1f}" for name, whole, packed in rows]
    return "\n".join(lines)


def make_release(output: Path, platforms: Iterable[str], progress: Progress) -> SundialsSource:
    """Writes output whole or not at all; ReleaseError says why not."""
    platforms = list(platforms)
    zig()
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        if output.is_dir():
            raise ReleaseError(f"{output} can't be written: it is a folder")
        with tempfile.TemporaryFile(dir=output.parent):
            pass
    except OSError as error:
        raise ReleaseError(f"{output} can't be written: {error.strerror}") from None
    task = progress.add_task("SUNDIALS' source", total=len(platforms) + 2)
    sundials = fetched(SUNDIALS)

    def tell(platform: str) -> None:
        progress.update(task, advance=1, description=f"Compiling for {platform}")

    with tempfile.TemporaryDirectory(prefix="release-") as temporary:
        folder = Path(temporary)
        libraries = compile_platforms(platforms, folder, sundials, tell=tell)
        progress.update(task, advance=1, description="Packing and validating")
        pack(output, with_universal_darwin(libraries, folder), folder / "variables.c", sundials, folder)
    progress.remove_task(task)
    return sundials


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="scripts/release",
        description="Build one FrictionContact.fmu for Linux, Windows and macOS, cross-compiled with zig.",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FMU", help="default: build/release/FrictionContact.fmu"
    )
    parser.add_argument(
        "--platforms", nargs="+", choices=list(TARGETS), metavar="PLATFORM", help=", ".join(TARGETS)
    )
    parser.add_argument(
        "--quick", action="store_true", help=f"{' and '.join(QUICK)} only, in build/release-quick"
    )
    arguments = parser.parse_args()
    output = (
        arguments.output
        or ROOT / "build" / ("release-quick" if arguments.quick else "release") / "FrictionContact.fmu"
    )
    platforms = arguments.platforms or (QUICK if arguments.quick else list(TARGETS))
    try:
        with progress_bar() as progress:
            sundials = make_release(output, platforms, progress)
    except KeyboardInterrupt:
        sys.exit("error: interrupted; nothing was written")
    except ReleaseError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        sys.exit(f"error: {error.filename}: {error.strerror}")
    print(size_table(output))
    print(f"SUNDIALS {sundials.version} (sha256 {sundials.sha256})")
    print(f"zig {importlib.metadata.version('ziglang')}")
    shown = output.relative_to(ROOT) if output.is_relative_to(ROOT) else output
    print(f"{shown} (sha256 {hashlib.sha256(output.read_bytes()).hexdigest()})")


if __name__ == "__main__":
    main()
