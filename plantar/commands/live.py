"""`plantar live`: record soles as their readings come."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, end_command
from plantar.common.console.progress import progress_bar


def live(
    source: Annotated[str, Argument(help="Source, and its address after a colon; plantar list sources lists them.")],
    layout: Annotated[Path | None, Option(help="Sole layout (.json); mirrored for the other foot.")] = None,
    seconds: Annotated[float, Option(help="How long; without it until the source ends, or Ctrl-C.")] = float("inf"),
    output: Annotated[Path, Option("-o", "--output", help="The recording to write.")] = Path("out/live.mcap"),
    as_json: Json = False,
) -> None:
    """Record soles as their readings come, and show load and center of pressure.

    The recording opens in plantar analyze, plantar view and Foxglove.

    Example: my_insole | plantar live lines --layout layout_left.json -o walk.mcap

    Example: plantar live replay:run.mcap --seconds 5
    """
    from plantar.common.atomic import keep_inputs, parent_folder
    from plantar.layouts.layout_file import read_layout
    from plantar.live.record import record
    from plantar.live.source import open_live

    keep_inputs(output, [source.partition(":")[2], layout])
    stream = open_live(source, None if layout is None else read_layout(layout))
    with parent_folder(output), progress_bar() as progress:
        found = {"file": str(output), **record(stream, output, seconds, progress)}
    feet = "".join(
        f"\n  {side}: {one['frames']} readings, {one['rate_hz'] or 0:.0f} Hz, gap up to {one['gap_max_s'] or 0:g} s"
        for side, one in found["feet"].items()
    )
    end_command(found, as_json, f"{found['seconds']:.1f} s recorded{feet}\n  {output}")


COMMAND = Command(live, "Record soles as their readings come.", 45)
