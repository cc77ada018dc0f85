"""`python -m plantar`: the command line."""

from plantar.cli import main

__all__: list[str] = []

if __name__ == "__main__":
    main()
