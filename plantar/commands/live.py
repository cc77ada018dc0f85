"""`plantar live`: record soles as their readings come."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, Option

from plantar.common.console.command import Command, Json, end_command
from plantar.common.console.ending import print_note
from plantar.common.console.progress import progress_bar


def live(
    source: Annotated[str, Argument(help="Source, and its address after a colon; plantar list sources lists them.")],
    layout: Annotated[Path | None, Option(help="Sole layout (.json); mirrored for the other foot.")] = None,
    seconds: Annotated[float, Option(help="How long; without it until the source ends, or Ctrl-C.")] = float("inf"),
    kind: Annotated[str | None, Option(help="What measures: robot, insole or platform.")] = None,
    send: Annotated[
        list[str] | None, Option(metavar="SINK", help="Where readings go on to, such as udp:9871; repeatable.")
    ] = None,
    counts: Annotated[bool, Option("--counts", help="Values are counts, for the layout's calibration.")] = False,
    correct_clocks: Annotated[bool, Option("--correct-clocks", help="Put both soles on the left one's clock.")] = False,
    strict: Annotated[bool, Option("--strict", help="End with exit 2 at what is not a reading in order.")] = False,
    page: Annotated[bool, Option("--page", help="Show it in the browser as it comes, on this machine.")] = False,
    page_address: Annotated[
        str | None, Option(metavar="HOST:PORT", help="Where, such as :8080; 0.0.0.0:8080 for others.")
    ] = None,
    output: Annotated[Path, Option("-o", "--output", help="The recording to write.")] = Path("out/live.mcap"),
    as_json: Json = False,
) -> None:
    """Record soles as their readings come, and show load and center of pressure.

    What is not a reading, repeats, restarts, gaps and clocks that differ are counted, and events in the recording.
    It opens in plantar analyze, plantar view and Foxglove. With --page both soles are shown as they come: forces, CoP
    and its trail, polygon, steps, cadence and symmetry, with buttons for zero, mark and record, and feedback above a
    force.

    Example: my_insole | plantar live lines --layout layout_left.json -o walk.mcap

    Example: plantar live serial:/dev/ttyACM0 --layout layout_left.json --kind insole

    Example: plantar live udp:9870 --layout layout_left.json --page

    Example: plantar live replay:run.mcap --seconds 5 --send udp:9871
    """
    from plantar.common.atomic import keep_inputs, parent_folder
    from plantar.formats.nominal_insole import named_or_read_layout
    from plantar.live import open_live
    from plantar.live.record import record
    from plantar.live.sink import open_sink

    keep_inputs(output, [source.partition(":")[2], layout])
    sinks = [open_sink(text) for text in send or []]
    sole = None if layout is None else named_or_read_layout(layout)
    stream = open_live(source, sole, strict=strict, correct=correct_clocks, kind=kind, counts=counts)
    if stream.unit == "counts":
        print_note(
            "the values are counts, recorded as they are: plantar calibrate, then --counts, makes newtons of them"
        )
    with parent_folder(output), progress_bar() as progress:
        if page:
            made = _with_page(stream, source, page_address, output, seconds, progress, sinks)
        else:
            made = record(stream, output, seconds, progress, sinks)
    found = {"file": str(output), **made}
    lines = [f"{found['seconds']:.1f} s recorded", *_feet_lines(found), *_fault_lines(found), f"  {output}"]
    end_command(found, as_json, "\n".join(lines))


def _with_page(
    stream: Any, source: str, address: str | None, output: Path, seconds: float, progress: Any, sinks: Sequence[Any]
) -> dict[str, Any]:
    from plantar.live.udp import host_and_port
    from plantar.viewer.live_page import LivePage
    from plantar.viewer.live_session import record_with_page

    host, port = ("127.0.0.1", 0) if address is None else host_and_port(address, "page")
    with LivePage(stream.soles, f"Live: {source}", host, port, stream.unit) as shown:
        print_note(f"page: {shown.url}")
        return record_with_page(stream, shown, output, seconds, progress, sinks)


def _feet_lines(found: Mapping[str, Any]) -> list[str]:
    return [
        f"  {side}: {one['frames']} readings, {one['rate_hz'] or 0:.0f} Hz, gap up to {one['gap_max_s'] or 0:g} s"
        for side, one in found["feet"].items()
    ]


def _fault_lines(found: Mapping[str, Any]) -> list[str]:
    counts = ", ".join(f"{kind.replace('_', ' ')} {count}" for kind, count in found["faults"].items() if count)
    lines = [f"  faults: {counts or 'none'}"]
    clocks = found["clocks"]
    if clocks is not None:
        rate = "" if clocks["rate_ppm"] is None else f", {clocks['rate_ppm']:+.0f} ppm"
        done = "corrected" if clocks["corrected"] else "not corrected"
        lines.append(f"  clocks: right minus left {clocks['right_minus_left_s']:+.3f} s{rate}, {done}")
    return lines


COMMAND = Command(live, "Record soles as their readings come.", 45)
