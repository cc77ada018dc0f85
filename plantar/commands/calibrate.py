"""`plantar calibrate`: turn counts of soles into newtons, or check that they still are."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, end_command
from plantar.errors import InputError

if TYPE_CHECKING:
    from plantar.calibration import Take


def calibrate(
    layout: Annotated[
        Path, Argument(metavar="LAYOUT", help="Sole layout (.json), or the word check.", show_default=False)
    ],
    checked: Annotated[Path | None, Argument(metavar="CALIBRATED.json", help="After check: the layout.")] = None,
    recording: Annotated[Path | None, Argument(metavar="RECORDING", help="After it: ten seconds of counts.")] = None,
    zero: Annotated[
        list[Path] | None, Option(metavar="FILE", help="Counts with nothing on the soles; repeatable.")
    ] = None,
    press: Annotated[
        list[Path] | None, Option(metavar="FILE", help="Counts of a sole that is pressed by known forces.")
    ] = None,
    scale: Annotated[
        list[Path] | None,
        Option(metavar="FILE", help="For each --press: table of time and force, as of a scale below the sole."),
    ] = None,
    motion: Annotated[
        list[Path] | None, Option(metavar="FILE", help="Counts of soles that a body stands, leans and steps on.")
    ] = None,
    reference: Annotated[
        list[Path] | None,
        Option(metavar="FILE", help="For each --motion: table of time, force and center of pressure of a robot."),
    ] = None,
    weight: Annotated[float | None, Option(help="Weight of the body in N, where no reference is given.")] = None,
    mass: Annotated[float | None, Option(help="Its mass in kg, instead of its weight.")] = None,
    output: Annotated[Path, Option("-o", "--output", help="The calibrated layout.")] = Path("out/calibrated.json"),
    as_json: Json = False,
) -> None:
    """Find gain, offset, response curve, hysteresis, creep and crosstalk of soles that give counts, with intervals.

    Recordings hold counts, as plantar live writes them or as a table. What you have is enough to begin: zero, then a
    body of known weight that stands, leans and steps for a minute (--motion, --weight); better, a robot's load and
    center of pressure by joints, IMU and mass (--reference); best, a minute of rolling a ball over each sole on a scale
    (--press, --scale), or weights on single taxels. What was not observed is printed.

    With check, a body of known weight stands still for some seconds and lifts each foot once; exit code 1 if the
    calibration does not hold any more.

    Example: plantar calibrate layout_left.json --zero air.csv --motion walk.csv --mass 71.5 -o mine.json

    Example: plantar calibrate layout_left.json --zero air.csv --press left.csv --scale left_scale.csv -o mine.json

    Example: plantar calibrate check mine.json today.csv --mass 71.5
    """
    load = _load_of(weight, mass)
    if str(layout) == "check":
        _check(checked, recording, load, as_json)
        return
    if checked is not None or recording is not None:
        raise InputError("recordings are given by --zero, --press and --motion; allowed beside: check LAYOUT RECORDING")
    files = {
        "zero": zero or [],
        "press": press or [],
        "scale": scale or [],
        "motion": motion or [],
        "reference": reference or [],
    }
    _fit(layout, files, load, output, as_json)


def _load_of(weight: float | None, mass: float | None) -> float | None:
    """Weight in N of the body by either option; None without one."""
    from plantar.mechanics.lip import GRAVITY

    if weight is not None and mass is not None:
        raise InputError("weight and mass are both given; allowed: one of them")
    load = weight if mass is None else mass * GRAVITY
    if load is not None and not 0.0 < load < 1e5:
        raise InputError(f"a body of {load:g} N; allowed: above 0 and below 100000 N")
    return load


def _check(layout: Path | None, recording: Path | None, load: float | None, as_json: bool) -> None:
    """Whether a layout's calibration still holds for a body of a known weight."""
    from plantar.calibration import check_calibration, read_take
    from plantar.layouts.layout_file import read_layout

    if layout is None or recording is None or load is None:
        raise InputError("check needs them all: plantar calibrate check LAYOUT RECORDING --mass 71.5")
    result = check_calibration(read_take("motion", recording, load), read_layout(layout))
    end_command(result.as_dict(), as_json, result.text(), result.failures, not result.holds)


def _fit(layout: Path, files: dict[str, list[Path]], load: float | None, output: Path, as_json: bool) -> None:
    """Calibrate a layout by files of each kind, and write it."""
    from plantar.calibration import calibrate as fitted
    from plantar.common.atomic import keep_inputs, parent_folder
    from plantar.layouts.layout_file import read_layout, write_layout

    found = fitted(_takes(files, load), read_layout(layout))
    keep_inputs(output, [file for kind in files.values() for file in kind])
    with parent_folder(output):
        write_layout(found.layout, output)
    end_command({**found.as_dict(), "file": str(output)}, as_json, f"{found.text()}\n  {output}")


def _takes(files: dict[str, list[Path]], load: float | None) -> "list[Take]":
    """What was measured: each press with its scale, each motion with its reference or the body's weight."""
    from plantar.calibration import read_take

    for kind, beside in (("press", "scale"), ("motion", "reference")):
        optional = kind == "motion" and not files[beside]
        if not optional and len(files[kind]) != len(files[beside]):
            raise InputError(
                f"{len(files[kind])} of --{kind} and {len(files[beside])} of --{beside}; allowed: one for each"
            )
    if files["motion"] and not files["reference"] and load is None:
        raise InputError("--motion needs --weight or --mass of the body, or --reference")
    takes = [read_take("zero", file) for file in files["zero"]]
    takes += [read_take("press", *pair) for pair in _with_table(files["press"], files["scale"])]
    if files["reference"]:
        return takes + [read_take("motion", *pair) for pair in _with_table(files["motion"], files["reference"])]
    return takes + [read_take("motion", file, load) for file in files["motion"]]


def _with_table(files: list[Path], tables: list[Path]) -> list[tuple[Path, None, Path]]:
    """Arguments of `read_take` for recordings with a table beside each."""
    return [(file, None, table) for file, table in zip(files, tables, strict=True)]


COMMAND = Command(calibrate, "Turn counts of soles into newtons, with their uncertainty.", 46)
