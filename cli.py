"""The command line: `plantar <command>`. Heavy libraries are imported inside the command that needs them."""

from __future__ import annotations

import sys

import typer

from plantar.errors import PlantarError

app = typer.Typer(
    name="plantar",
    help="Plantar skin and gait: build a tactile shoe, walk a robot on plantar feedback, analyse recordings.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def main() -> None:
    """Entry point of the console script: errors become one line and exit code 2."""
    try:
        app()
    except PlantarError as error:
        print(f"plantar: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
