"""`plantar sole`: what a sole perceives at an instant of a recording."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, Output, end_command, file_lines


def sole(
    recording: Annotated[
        Path, Argument(metavar="RECORDING", help="Recording of any known format.", show_default=False)
    ],
    at: Annotated[float | None, Option(help="Time in s. Default: the instant of the greatest load.")] = None,
    foot: Annotated[
        str | None, Option(metavar="left|right", help="Which foot. Default: the one with the greater load then.")
    ] = None,
    layout: Annotated[Path | None, Option(help="Layout file, where the recording has none.")] = None,
    output: Output = Path("out/sole"),
    as_json: Json = False,
) -> None:
    """Show what a sole perceives at an instant: one picture and one JSON of its taxels.

    Center of pressure, wrench, convex and concave polygon, inscribed rectangle and circle; where proximity is recorded
    also height contours, preemptive polygon and virtual wrench.

    Example: plantar sole run.mcap -o out/sole

    Example: plantar sole run.mcap --at 3.2 --foot left --json
    """
    from plantar.viewer.sole_view import sole as view_of

    view = view_of(recording, at, foot, layout=layout)
    files = [str(path) for path in view.save(output)]
    lines = [f"{view.side} sole at {view.time:.3f} s", *(f"  {line}" for line in view.lines())]
    text = "\n".join(lines) + file_lines(files)
    end_command({**view.as_dict(), "files": files}, as_json, text)


COMMAND = Command(sole, "Show what a sole perceives at an instant: CoP, wrench, polygons.", 25)
