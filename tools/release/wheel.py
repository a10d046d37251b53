"""\
Makes a wheel of this clone for the platform it runs on: the Python package with the FMU, the batch host, the
page of the live FMU and the measurements inside. pip installs it where there is no compiler."""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from frictioncontact import resources
from frictioncontact.command import add_output, command_line, say_written
from frictioncontact.errors import UserError
from tools.build import build_fmu
from tools.playground.page import page_text
from tools.project import ROOT
from tools.release.build_hook import PAGE
from tools.release.targets import PLATFORMS


def wheels(fmu: Path, page: Path, hosts: Mapping[str, Path], output: Path) -> list[Path]:
    """A wheel for each platform with its batch host, and the sdist, in the folder output."""
    made = [packed("wheel", output, [fmu, page, host], PLATFORMS[name].tag) for name, host in hosts.items()]
    return [*made, packed("sdist", output, [page])]


def packed(target: str, output: Path, files: Sequence[Path], tag: str = "") -> Path:
    """Runs hatchling for a target, wheel or sdist, with these files in the bundle; UserError says why not."""
    with tempfile.TemporaryDirectory(prefix="bundle-") as temporary:
        bundle, made = Path(temporary, "bundle"), Path(temporary, "made")
        bundle.mkdir()
        for path in files:
            shutil.copy(path, bundle)
        command = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(made)]
        given = {"FRICTIONCONTACT_BUNDLE": str(bundle), "FRICTIONCONTACT_PLATFORM": tag}
        run = subprocess.run(command, cwd=ROOT, env=os.environ | given, capture_output=True, text=True)
        if run.returncode:
            raise UserError(f"the {target} fails: {' '.join(run.stderr.split())[-300:]}")
        (path,) = made.iterdir()
        output.mkdir(parents=True, exist_ok=True)
        return Path(shutil.move(path, output / path.name))


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    parser = command_line("scripts/wheel", __doc__)
    add_output(parser, ROOT / "build" / "wheel")
    return parser.parse_args(argv)


def run(options: argparse.Namespace) -> None:
    fmu = build_fmu()
    with tempfile.TemporaryDirectory(prefix="page-") as temporary:
        page = Path(temporary, PAGE)
        page.write_text(page_text(), encoding="utf-8")
        wheel = packed("wheel", options.output, [fmu, page, resources.batch_host()])
    say_written([wheel])
    print(f"{wheel.stat().st_size / 1e6:.2f} MB")
