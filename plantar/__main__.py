"""`python -m plantar` and the console script; Ctrl-C ends it from its first moment."""

import os

from plantar.common.console.ending import leave_at_interrupt


def main() -> None:
    """Entry point of the console script.

    Example:
        >>> main()  # doctest: +SKIP
    """
    leave_at_interrupt()
    # Matrices here are small: threads of one solve wait for each other, ten times as long beside other work.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from plantar import cli

    cli.main()


if __name__ == "__main__":
    main()
