"""The command `frictioncontact NAME ARGS`, which runs the command of that name."""

from __future__ import annotations

import argparse
import importlib
import signal
import sys
from collections.abc import Callable

COMMANDS = {  # name -> its room, and what it does
    "table2": ("table2", "the six rows of the paper's Table 2"),
    "simulate": ("simulation", "one scene over time, as a table"),
    "sweep": ("sweeps", "many scenarios on all cores or a Dask cluster, into Parquet"),
    "identify": ("identification", "fits parameters to your measurements"),
    "advise": ("advice", "what to set for your scene and accuracy"),
    "gap": ("gap", "the separation for a normal load, and the load for a separation"),
    "validate": ("validate", "every law of friction against published measurements"),
    "playground": ("playground", "one web page with the FMU alive in it"),
    "version": ("", "the version of the package, and the path of its FMU"),
}


def main() -> None:
    """The entry point: `frictioncontact NAME ARGS`."""
    interruptible(_chosen)


def _chosen() -> Callable[[], None]:
    name = sys.argv[1] if len(sys.argv) > 1 else "--help"
    if name in ("-h", "--help"):
        return _usage
    if name in ("version", "--version"):
        return _version
    if name not in COMMANDS:
        sys.exit(f"error: {name[:40]!r} is no command; these are: {', '.join(COMMANDS)}")
    del sys.argv[1]
    try:
        return importlib.import_module(f"frictioncontact.{COMMANDS[name][0]}.command").main
    except ModuleNotFoundError as missing:
        if missing.name != "pyarrow":
            raise
        sys.exit(f"error: {missing}")


def _usage() -> None:
    lines = ["usage: frictioncontact COMMAND ...", "", "commands, each with --help:"]
    _say(lines + [f"  {name:<12} {does}" for name, (_, does) in COMMANDS.items()])


def _version() -> None:
    import frictioncontact

    _say([f"frictioncontact {frictioncontact.__version__}", str(frictioncontact.FMU)])


def _say(lines: list[str]) -> None:
    from frictioncontact.command import finish

    finish(lambda options: print("\n".join(lines)), argparse.Namespace())


def interruptible(load: Callable[[], Callable[[], None]]) -> None:
    """Loads a command and runs it; Control-C is one line and exit status 130 from the first import on.

    The line is what the KeyboardInterrupt says, or "stopped".
    """
    asked = False

    def interrupt(*_: object) -> None:
        nonlocal asked
        asked = True
        raise KeyboardInterrupt

    heeded = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if heeded:
        signal.signal(signal.SIGINT, interrupt)
    if hasattr(signal, "SIGALRM"):  # not on Windows
        sys.unraisablehook = _take_up
        signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        run = load()
        if asked:  # and some import caught it
            raise KeyboardInterrupt
        run()
    except KeyboardInterrupt as stopped:
        _stopped(str(stopped))
    except Exception:
        if not asked:
            raise
        _stopped()  # NumPy's import makes an ImportError of it
    finally:
        if hasattr(signal, "SIGALRM"):
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        if heeded:
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be tidied up


def _take_up(dropped: sys.UnraisableHookArgs) -> None:
    """A Control-C that fell into a destructor or a callback, where Python drops exceptions, comes again."""
    if issubclass(dropped.exc_type, KeyboardInterrupt):
        signal.setitimer(signal.ITIMER_REAL, 0.01)
    else:
        sys.__unraisablehook__(dropped)


def _stopped(said: str = "") -> None:
    print(said or "stopped", file=sys.stderr)
    sys.exit(130)


if __name__ == "__main__":
    main()
