"""One FMU for Linux, Windows and macOS."""
