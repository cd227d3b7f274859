"""The command `usar`."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import NoReturn

from ._usar import command


def main() -> NoReturn:
    """Run the command with the words of this process."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the command has a way of its own to stop
    program = Path(sys.executable).with_name("usar")  # where scripts of a cluster find it
    os._exit(command([str(program) if program.exists() else "usar", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
