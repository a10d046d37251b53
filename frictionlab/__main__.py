"""Runs main() of a command's module, as the files of scripts/ do: `python -m frictionlab sweep.command ARGS`.

Control-C is one line and exit status 130 from the first import on.
"""

from __future__ import annotations

import importlib
import signal
import sys


def main() -> None:
    del sys.argv[0]
    asked = False

    def interrupt(*_: object) -> None:
        nonlocal asked
        asked = True
        raise KeyboardInterrupt

    heeded = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if heeded:
        signal.signal(signal.SIGINT, interrupt)
    sys.unraisablehook = _take_up
    signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        command = importlib.import_module(f"frictionlab.{sys.argv[0]}")
        if asked:  # and some import caught it
            raise KeyboardInterrupt
        sys.exit(command.main())
    except KeyboardInterrupt:
        _stopped()
    except Exception:
        if not asked:
            raise
        _stopped()  # NumPy's import makes an ImportError of it
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        if heeded:
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be tidied up


def _take_up(dropped: sys.UnraisableHookArgs) -> None:
    """A Control-C that fell into a destructor or a callback, where Python drops exceptions, comes again."""
    if issubclass(dropped.exc_type, KeyboardInterrupt):
        signal.setitimer(signal.ITIMER_REAL, 0.01)
    else:
        sys.__unraisablehook__(dropped)


def _stopped() -> None:
    print("stopped", file=sys.stderr)
    sys.exit(130)


if __name__ == "__main__":
    main()
