"""`python -m plantar` and the console script; Ctrl-C ends it from its first moment."""

from plantar.console.ending import leave_at_interrupt

__all__ = ["main"]


def main() -> None:
    """Entry point of the console script.

    Example:
        >>> main()  # doctest: +SKIP
    """
    leave_at_interrupt()
    from plantar import cli

    cli.main()


if __name__ == "__main__":
    main()
