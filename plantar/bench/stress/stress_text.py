"""A stress run in words."""

from __future__ import annotations

from plantar.bench.stress.stress_run import StressResult

__all__ = ["stress_text"]


def stress_text(result: StressResult) -> str:
    """What a stress run saw, for people.

    Args:
        result: The run.

    Returns:
        Lines: a function each with its worst error, its bound and its failures.
    """
    lines = [f"{'function':66}{'readings':>10}{'worst':>10}{'bound':>10}{'failures':>10}"]
    for name, tested in sorted(result.functions.items()):
        lines.append(f"{name:66}{tested.readings:>10}{tested.worst:>10.1e}{tested.bound:>10.1e}{tested.failures:>10}")
        lines += [f"    {example}" for example in tested.examples]
    lines.append(f"{result.readings} readings in {result.seconds:.0f} s: {result.failures} failures")
    return "\n".join([*lines, f"every function met {result.least} readings or more"])
