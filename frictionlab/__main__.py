"""Runs a command by its module, as the files of scripts/ do: `python -m frictionlab sweep.command ARGS`.

Control-C is one line and exit status 130 from the first import on.
"""

import runpy
import sys


def main() -> None:
    del sys.argv[0]
    try:
        runpy.run_module(f"frictionlab.{sys.argv[0]}", run_name="__main__", alter_sys=True)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        sys.exit(130)


if __name__ == "__main__":
    main()
