"""The command line: the script `stiction` and `python -m stiction`."""

from __future__ import annotations

import os
import sys

from . import _native


def main() -> int:
    """Runs the command line with the arguments of the process; its exit code."""
    # Else the next file that is opened would take the place of one that is closed, and be printed into.
    for standard in range(3):
        try:
            os.fstat(standard)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    return _native.command(sys.argv[1:])
