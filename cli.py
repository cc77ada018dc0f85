"""Start the command line from the checkout: `python cli.py`, the same as `plantar` and `python -m plantar`."""

from plantar.cli import main

if __name__ == "__main__":
    main()
