"""`python -m plantar` and the console script; Ctrl-C ends it from its first moment."""

import os
import sys
from importlib import import_module

from plantar.common.console.ending import leave_at_interrupt, run


def main() -> None:
    """Entry point of the console script.

    Example:
        >>> main()  # doctest: +SKIP
    """
    leave_at_interrupt()
    # Matrices here are small: threads of one solve wait for each other, ten times as long beside other work.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from plantar import cli
    except ModuleNotFoundError:  # the command line's own libraries
        sys.exit(run(_load))
    cli.main()


def _load() -> None:
    import_module("plantar.cli")


if __name__ == "__main__":
    main()
