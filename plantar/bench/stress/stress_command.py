"""The command that throws readings at the perception: `plantar bench kernels --stress`."""

from __future__ import annotations

from plantar.bench.stress.stress_run import stress
from plantar.bench.stress.stress_text import stress_text
from plantar.console.command import end_command
from plantar.console.progress import progress_bar

__all__ = ["stress_command"]


def stress_command(readings: int, seed: int, as_json: bool) -> None:
    """Throw odd readings at the perception, and tell what came of it.

    Args:
        readings: How many.
        seed: Seed of what is left to chance.
        as_json: Whether a program reads the result.

    Raises:
        typer.Exit: With exit code 1, if something failed.
    """
    with progress_bar() as tell:
        result = stress(readings, seed, progress=tell)
    failures = [f"{result.failures} failures in {result.readings} readings"] if result.failures else []
    end_command(result.as_dict(), as_json, stress_text(result), failures, bool(result.failures))
