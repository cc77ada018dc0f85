"""The figures of `plantar bench skip` in words and tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from plantar.bench.tables import markdown_table
from plantar.sim.bench.room_times import ROOMS
from plantar.sim.bench.skip_row import SkipRow

__all__ = ["skip_page", "skip_text"]


def skip_text(result: Mapping[str, Any]) -> str:
    """The main figures for people.

    Args:
        result: What `measure_skipping` gave.

    Returns:
        Lines.
    """
    lines = [f"{'scene':12}{'robot':10}{'x real time':>12}{'rest/physics':>14}{'saved':>8}  motion"]
    for row in result["scenes"]:
        factor = row["sim_s"] / row["run_s"]
        motion = "same" if row["same_motion"] else "NOT THE SAME"
        lines.append(
            f"{row['scene']:12}{row['robot']:10}{factor:>12.1f}{row['factor']:>14.2f}{row['saved']:>7.1f}x  {motion}"
        )
    return "\n".join(lines)


def skip_page(rows: Sequence[SkipRow]) -> str:
    """The page.

    Args:
        rows: The scenes; one at least.

    Returns:
        Markdown.
    """
    parts = [_HEAD, _times(rows), _ROOMS, _rooms(rows), _COUNTS, _counts(rows)]
    return "\n".join(part.strip("\n") + "\n" for part in parts)


_HEAD = """# What a scene's time goes to, and what is skipped

Written by `plantar bench skip -o DIR`; the figures are one run of it. Times depend on the machine and on what else it
does, so the runs of a scene take turns and medians of the rounds count. `physics alone` is the same motion once more by
`mj_step` in a loop, from the same state with the same controls; `rest / physics` is everything but that, over that, in
the run as it is. `with everything` computes each member of each percept, casts every ray and records the run; `saved`
says how many times less everything but the physics takes without. `same motion` compares a hash of all positions of all
physics steps.
"""

_ROOMS = """## Where the time goes

Share of each room in the run as it is, in percent, by a look a millisecond at which function the program is in.
Physics takes longer here than alone, since what runs in between has taken its place in the processor's caches.
"""

_COUNTS = """## What was skipped

How many were left out of the run, of how many that there could have been. Where the least of a kind is computed, it is
because somebody asked for it.
"""


def _times(rows: Sequence[SkipRow]) -> str:
    return markdown_table(
        ("scene", "robot", "settings", "real-time factor", "run [s]", "with everything [s]", "physics alone [s]",
         "rest / physics", "saved", "same motion"),
        [
            (
                *(row.scene, row.robot, row.settings),
                *(f"{row.sim_s / row.run_s:.1f}", f"{row.run_s:.2f}", f"{row.everything_s:.2f}"),
                *(f"{row.physics_s:.3f}", f"{row.factor:.2f}", f"{row.saved:.1f} x"),
                "yes" if row.same_motion else "**no**",
            )
            for row in rows
        ],
    )  # fmt: skip


def _rooms(rows: Sequence[SkipRow]) -> str:
    lines = [(row.scene, row.robot, *(f"{100.0 * row.shares.get(room, 0.0):.0f}" for room in ROOMS)) for row in rows]
    return markdown_table(("scene", "robot", *ROOMS), lines)


def _counts(rows: Sequence[SkipRow]) -> str:
    lines = []
    for row in rows:
        cells = [f"{row.skipped[name]} of {row.skipped[name] + row.computed[name]}" for name in row.skipped]
        lines.append((row.scene, row.robot, *cells))
    return markdown_table(("scene", "robot", *rows[0].skipped), lines)
