"""One .fmu that runs everywhere: `scripts/release`.

Every library is compiled by zig from the same sources, with SUNDIALS CVODE inside, then inspected. The file
appears under its name only when it is complete and the FMI validator finds nothing. The same input gives the
same bytes.
"""

import argparse
import importlib.metadata
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from fmpy.validation import validate_fmu
from rich.progress import Progress

from frictioncontact.command import command_line, progress_bar, shown
from frictioncontact.errors import UserError
from frictioncontact.files import whole_file
from tools.build import forget
from tools.packing.documentation import page as index_page
from tools.playground.page import page_text
from tools.project import ROOT
from tools.release import inspect as release_inspect
from tools.release.build_hook import PAGE
from tools.release.targets import PLATFORMS, build
from tools.release.universal import universal
from tools.release.verify import SUMS, verify, write_sums
from tools.release.wheel import wheels
from tools.zig import zig

QUICK = ("linux64", "aarch64-darwin")  # the compiler's two ways: with the linker's optimization, and without
SUNDIALS = ROOT / "build" / "sundials-source"
# Parts of the compiler's run-time library are linked into every binary, of MinGW-w64's into that of Windows.
TOOLCHAIN_LICENSES = {"zig-license.txt": "LICENSE", "mingw-w64-license.txt": "lib/libc/mingw/COPYING"}


def compile_platform(platform: str, progress: Progress | None = None) -> Path:
    """The library of a platform, in CMake's folder for it, inspected; beside it the wheel's batch host."""
    folder = build(platform, ["fmu_parts", "friction_batch"], progress)
    library = folder / f"FrictionContact{PLATFORMS[platform].suffix}"
    release_inspect.check(platform, library)
    release_inspect.check(platform, batch_host(library), "batch_")
    return library


def batch_host(library: Path) -> Path:
    """Beside a platform's library."""
    return library.with_name(f"friction_batch{library.suffix}")


def with_universal_darwin(libraries: dict[str, Path], folder: Path) -> dict[str, Path]:
    """darwin64 for both processors, where both were compiled."""
    if not {"darwin64", "aarch64-darwin"} <= libraries.keys():
        return libraries
    path = folder / "universal.dylib"
    slices = [libraries[name].read_bytes() for name in ("darwin64", "aarch64-darwin")]
    path.write_bytes(universal(slices))
    return {**libraries, "darwin64": path}


def documents(folder: Path) -> dict[str, Path]:
    """The page of the live FMU and index.html with a link to it, in folder: name in the FMU -> file."""
    files = {f"documentation/{name}": folder / name for name in ("index.html", PAGE)}
    files["documentation/index.html"].write_text(index_page(playground=True), encoding="utf-8")
    files[f"documentation/{PAGE}"].write_text(page_text(), encoding="utf-8")
    return files


def pack(output: Path, libraries: dict[str, Path], parts: Path, files: dict[str, Path]) -> None:
    """Writes output, if the validator finds nothing in it.

    parts: CMake's folder of one of the platforms; files: name in the FMU -> file, besides what CMake lists.
    """
    licenses = {f"documentation/licenses/{n}": zig().parent / path for n, path in TOOLCHAIN_LICENSES.items()}
    words = [f"@{parts / 'generated' / 'package.txt'}"]
    words += [f"--binary={platform}={library}" for platform, library in libraries.items()]
    words += [f"--file={name}={path}" for name, path in (licenses | files).items()]
    packer = [sys.executable, "-B", "-m", "tools.packing.archive"]
    with whole_file(output) as unchecked:
        command = [*packer, str(unchecked.absolute()), *words]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if done.returncode:
            raise UserError(f"packing fails: {' '.join(done.stderr.split())[-300:]}")
        problems = validate_fmu(str(unchecked))
        if problems:
            raise UserError(f"the validator finds: {' '.join(problems[0].split())}")


def make_release(output: Path, platforms: Sequence[str], progress: Progress) -> None:
    """Writes output whole or not at all, the page and the checksums beside it; UserError says why not."""
    zig()
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        if output.is_dir():
            raise UserError(f"{output} can't be written: it is a folder")
        with tempfile.TemporaryFile(dir=output.parent):
            pass
    except OSError as error:
        raise UserError(f"{output} can't be written: {error.strerror}") from None
    libraries: dict[str, Path] = {}
    task = progress.add_task("Compiling", total=len(platforms) + 3)
    for platform in platforms:
        progress.update(task, advance=1, description=f"Compiling for {platform}")
        libraries[platform] = compile_platform(platform, progress)
    with tempfile.TemporaryDirectory(prefix="release-") as temporary:
        folder = Path(temporary)
        progress.update(task, advance=1, description="Writing pages")
        files = documents(folder)
        progress.update(task, advance=1, description="Packing and validating")
        fmu, page = folder / "FrictionContact.fmu", files[f"documentation/{PAGE}"]
        parts = libraries[platforms[0]].parent
        pack(fmu, with_universal_darwin(libraries, folder), parts, files)
        progress.update(task, advance=1, description="Packing wheels")
        hosts = {platform: batch_host(library) for platform, library in libraries.items()}
        made = wheels(fmu, page, hosts, folder / "wheels")
        targets = {output: fmu, **{output.with_name(path.name): path for path in (page, *made)}}
        for target, path in targets.items():
            with whole_file(target) as unfinished:
                shutil.copyfile(path, unfinished)
        write_sums(list(targets))
    progress.remove_task(task)


def sundials_version() -> str:
    """Of the source that cmake/Sundials.cmake fetched: its number and the checksum of its archive."""
    numbers = re.findall(
        r'set\(PACKAGE_VERSION_(?:MAJOR|MINOR|PATCH) "(\d+)"\)', (SUNDIALS / "CMakeLists.txt").read_text()
    )
    return f"{'.'.join(numbers)} (sha256 {(SUNDIALS / 'archive.sha256').read_text().strip()})"


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    description = "Build one FrictionContact.fmu for Linux, Windows and macOS, cross-compiled with zig."
    parser = command_line("scripts/release", description)
    add = parser.add_argument
    add("-o", "--output", type=Path, metavar="FMU", help="default: build/release/FrictionContact.fmu")
    add("--platforms", nargs="+", choices=list(PLATFORMS), metavar="PLATFORM", help=", ".join(PLATFORMS))
    add("--quick", action="store_true", help=f"{' and '.join(QUICK)} only, in build/release-quick")
    what = "tell whether a file is one of ours, as it was packed, and gives its reference results"
    add("--check", type=Path, metavar="FMU", help=what)
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    if options.check:
        for line in verify(options.check):
            print(f"ok  {line}", flush=True)
        return
    name = "release-quick" if options.quick else "release"
    output = options.output or ROOT / "build" / name / "FrictionContact.fmu"
    platforms = options.platforms or (QUICK if options.quick else list(PLATFORMS))
    for platform in () if options.quick else platforms:
        forget(platform)
    with progress_bar() as progress:
        make_release(output, platforms, progress)
    print(f"SUNDIALS {sundials_version()}")
    print(f"zig {importlib.metadata.version('ziglang')}")
    for line in output.with_name(SUMS).read_text().splitlines():
        checksum, _, name = line.partition("  ")
        print(f"{shown(output.with_name(name))} (sha256 {checksum})")
