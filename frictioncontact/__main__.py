"""The command `frictioncontact NAME ARGS`, which runs the command of that name."""

import argparse
import importlib
import os
import signal
import sys
from collections.abc import Callable

COMMANDS = {  # name -> its module, and what it does
    "table2": ("table2", "the six rows of the paper's Table 2"),
    "simulate": ("simulation", "one scene over time, as a table"),
    "sweep": ("sweeps.run", "many scenarios on all cores or a Dask cluster, into Parquet"),
    "identify": ("identification.command", "fits parameters to your measurements"),
    "advise": ("advice.command", "what to set for your scene and accuracy"),
    "law": ("law", "the friction law under vibration, for slower machines: a table or a picture"),
    "contacts": ("measured", "contacts that were measured, as start values"),
    "gap": ("gap", "the separation for a normal load, and the load for a separation"),
    "validate": ("validate", "the measured contacts against their measurements"),
    "playground": ("playground", "one web page with the FMU alive in it"),
    "version": ("", "the version of the package, and the path of its FMU"),
}


def main() -> None:
    """The entry point: `frictioncontact NAME ARGS`."""
    interruptible(_chosen)


def _chosen() -> Callable[[], None]:
    name = sys.argv[1] if len(sys.argv) > 1 else "--help"
    if name in ("-h", "--help", "help"):
        return _usage
    if name in ("version", "--version"):
        return _version
    if name not in COMMANDS:
        from frictioncontact.errors import did_you_mean, shown

        hint = did_you_mean(name, COMMANDS)
        sys.exit(f"error: {shown(name)} is no command{hint or ';'} these are: {', '.join(COMMANDS)}")
    from frictioncontact.command import main_of

    del sys.argv[1]
    return main_of(importlib.import_module(f"frictioncontact.{COMMANDS[name][0]}"))


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
    before = signal.getsignal(signal.SIGINT)
    heeded = before is signal.default_int_handler
    try:
        if heeded:
            signal.signal(signal.SIGINT, _leave)
        run = load()
        signal.signal(signal.SIGINT, before)
        run()
    except KeyboardInterrupt as stopped:
        print(str(stopped) or "stopped", file=sys.stderr)
        sys.exit(130)
    finally:
        if heeded:
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be tidied up


def _leave(*_: object) -> None:
    """Ends at once: an import has nothing to tidy up, and may catch or change an exception."""
    os.write(2, b"stopped\n")
    os._exit(130)


if __name__ == "__main__":
    main()
