"""Compiles the FMU and the C unit tests again and again, with one file of fmu_src spoilt at a time."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import zipfile
from pathlib import Path

import fmpy

from frictionlab.project import ROOT, UserError

HEADERS = Path(fmpy.__file__).parent / "c-code"
SUNDIALS = "libsundials_cvode_static.a"
LIBRARY = "binaries/linux64/FrictionContact.so"
UNITS = ROOT / "tests" / "unit"
WRAPPED = "-Wl,--wrap=malloc,--wrap=calloc,--wrap=free"  # what tests/unit/test_memory.c counts

SHIPPED = ("-DNDEBUG",)
ASSERTED = ("-UNDEBUG",)


class Workshop:
    """A copy of fmu_src in a folder, with its objects.

    built: the FMU of the default preset; its folder holds the variable table, and SUNDIALS where it was built
    with it.
    """

    def __init__(self, folder: Path, built: Path) -> None:
        self.folder = folder
        self.built = built
        self.sources = folder / "fmu_src"
        shutil.copytree(ROOT / "fmu_src", self.sources)
        shutil.copy(built.parent / "generated" / "variables.c", self.sources)
        self.options = [f"-I{path}" for path in (self.sources, HEADERS, ROOT / "host", ROOT / "tests")]
        self.libraries = ["-lm"]
        if (built.parent / SUNDIALS).is_file():
            self._use_sundials()

    def _use_sundials(self) -> None:
        includes = (self.built.parent / "sundials-source" / "include", self.built.parent / "generated")
        self.options += ["-DFC_WITH_SUNDIALS", *(f"-isystem{path}" for path in includes)]
        machine_code = (
            self.folder / "sundials.a"
        )  # what link-time optimization left to be compiled, done once
        whole = ["-Wl,--whole-archive", str(self.built.parent / SUNDIALS), "-Wl,--no-whole-archive"]
        try:
            self._command(
                ["-O1", "-r", "-nostdlib", "-flinker-output=nolto-rel", *whole, "-o", str(machine_code)]
            )
        except UserError:
            machine_code = self.built.parent / SUNDIALS  # a compiler without that option
        self.libraries = [str(machine_code), "-lm"]

    def compile(self, *variants: tuple[str, ...]) -> None:
        """Compiles everything in these variants (SHIPPED, ASSERTED)."""
        for variant in variants:
            self._compile_all(variant)

    def copy(self, folder: Path) -> Workshop:
        """Another workshop with the same objects."""
        other = Workshop(folder, self.built)
        for compiled in self.folder.glob("*.o"):
            shutil.copy(compiled, folder)
        return other

    def write(self, name: str, text: str, *variants: tuple[str, ...]) -> None:
        """Gives fmu_src/name this text and compiles what depends on it; UserError if that can't be done."""
        path = self.sources / name
        path.write_text(text)
        for variant in variants:
            if path.suffix == ".c":
                self._compile(path, variant)
            else:
                self._compile_all(variant)

    def object_code(self, name: str, variant: tuple[str, ...]) -> bytes:
        """What a source was compiled to; of everything where the name is that of a header."""
        named = [self.sources / name] if name.endswith(".c") else self._all()
        return b"".join(self._object(source, variant).read_bytes() for source in named)

    def fmu(self) -> Path:
        """The FMU with the objects as they are, in the variant SHIPPED."""
        library, packed = self.folder / "FrictionContact.so", self.folder / "FrictionContact.fmu"
        self._link(library, SHIPPED, ["-shared", "-Wl,--exclude-libs,ALL"])
        with zipfile.ZipFile(self.built) as original, zipfile.ZipFile(packed, "w") as new:
            for name in original.namelist():
                new.writestr(name, library.read_bytes() if name == LIBRARY else original.read(name))
        return packed

    def units(self) -> list[Path]:
        """The programs of tests/unit with the objects as they are, in the variant ASSERTED."""
        programs = []
        for source in sorted(UNITS.glob("test_*.c")):
            program = self.folder / source.stem
            test = self.folder / f"{source.stem}.o"
            needs: list[str] = []
            if source.stem == "test_memory":
                host = [str(ROOT / "host" / name) for name in ("fmi2_linked.c", "fmi2_library.c")]
                needs = [*host, WRAPPED, *self.options]
            self._link(program, ASSERTED, [str(test), *needs])
            programs.append(program)
        return programs

    def _all(self) -> list[Path]:
        return sorted(self.sources.rglob("*.c"))

    def _compile_all(self, variant: tuple[str, ...]) -> None:
        for source in self._all():
            self._compile(source, variant)
        for test in sorted(UNITS.glob("test_*.c")) if variant == ASSERTED else []:
            self._cc(*ASSERTED, "-c", str(test), "-o", str(self.folder / f"{test.stem}.o"))

    def _object(self, source: Path, variant: tuple[str, ...]) -> Path:
        name = "-".join(source.relative_to(self.sources).parts)
        return self.folder / f"{name}{variant[0]}.o"

    def _compile(self, source: Path, variant: tuple[str, ...]) -> None:
        folder = f"-I{source.parent}"
        self._cc(folder, *variant, "-fPIC", "-c", str(source), "-o", str(self._object(source, variant)))

    def _link(self, target: Path, variant: tuple[str, ...], more: list[str]) -> None:
        objects = [str(self._object(source, variant)) for source in self._all()]
        self._command([*more, *objects, *self.libraries, "-ldl", "-o", str(target)])

    def _cc(self, *arguments: str) -> None:
        self._command(["-std=c11", "-O1", "-w", "-ffp-contract=off", *self.options, *arguments])

    def _command(self, arguments: list[str]) -> None:
        command = [*shlex.split(os.environ.get("CC", "cc")), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise UserError(done.stderr)
