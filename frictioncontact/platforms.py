"""Where an FMU has the shared library for this machine."""

from collections.abc import Collection

import fmpy

# The platform tuple of FMI 3.0, section 2.5.1.4.1, then FMI 2.0's name. FMPy takes linux64 on ARM too, though
# FMI 2.0 means x86-64 by it.
FOLDERS = (fmpy.platform_tuple, fmpy.platform)


def library_in(members: Collection[str], identifier: str) -> str | None:
    """Of the files of an FMU, with paths as in the archive, the library; None where there is none."""
    wanted = (f"binaries/{folder}/{identifier}{fmpy.sharedLibraryExtension}" for folder in FOLDERS)
    return next((path for path in wanted if path in members), None)
