"""The command line: `python -m chordal part.step`."""

from __future__ import annotations

import sys

from ._native import run_command_line


def main() -> int:
    """Runs the command line with the arguments of this process and returns the exit code."""
    sys.stdout.flush()
    return run_command_line(["chordal", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
