"""The command line: `plantar <command>`. Heavy libraries are imported inside the command that needs them."""

from __future__ import annotations

import json
import os
import signal
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from plantar import __version__
from plantar.atomic import write_text
from plantar.console import BAD_INPUT, Terminated, run
from plantar.errors import InputError, RobotError

if TYPE_CHECKING:
    from plantar.settings.schema import Setting

app = typer.Typer(
    name="plantar",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

_SIM = ("mujoco", "scipy", "daqp")
"""What every module of the simulator imports of its extra."""


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"plantar {__version__}")
        raise typer.Exit


@app.callback()
def _commands(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Plantar skin and gait: build a tactile shoe, walk a robot on plantar feedback, analyse recordings."""


@app.command()
def shoe(
    foot: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FOOT]",
            help="Mesh of the foot (.stl .obj .ply .off .3mf .step), robot's model (.xml .urdf, with --body), "
            "or outline of its sole (.dxf .svg .geojson).",
            show_default=False,
        ),
    ] = None,
    robot: Annotated[str | None, typer.Option(help="A built-in robot instead of a file, for example h1.")] = None,
    body: Annotated[str | None, typer.Option(help="Name of the foot's body or link in a robot's model.")] = None,
    dimensions: Annotated[
        str | None,
        typer.Option(metavar="LxW[xR]", help="Length, width and corner radius of a box instead of a file, in mm."),
    ] = None,
    side: Annotated[str, typer.Option(help="left, right or both; the right shoe mirrors the left.")] = "both",
    cell_area: Annotated[float, typer.Option(help="Area of one taxel in mm^2, as the papers give it.")] = 691.0,
    taxels: Annotated[
        int | None,
        typer.Option(help="Number of taxels; may reach beyond the sole as far as needed. Default: as many as fit."),
    ] = None,
    overhang: Annotated[float, typer.Option(help="How far taxels may reach beyond the sole, in mm.")] = 0.0,
    mesh_side: Annotated[
        str | None, typer.Option(help="Which foot the file shows: left or right. Default: by the body's name, or left.")
    ] = None,
    unit: Annotated[str | None, typer.Option(help="Unit of the file: m, cm, mm, in. Default: from its size.")] = None,
    up: Annotated[str | None, typer.Option(help="Axis that points up: x, -x, y, -y, z, -z. Default: found.")] = None,
    forward: Annotated[str | None, typer.Option(help="Axis to the toes: x, -x, y, -y. Default: found.")] = None,
    sole_z: Annotated[
        float | None,
        typer.Option("--sole-z", help="Height of the sole plane in the mesh, in mm. Default: its lowest point."),
    ] = None,
    layout_only: Annotated[bool, typer.Option(help="Write only the layouts (under 2 s).")] = False,
    parameters: Annotated[
        Path | None, typer.Option(help="JSON or TOML file with parameters; their names are in docs/shoes.md.")
    ] = None,
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Change one parameter; repeatable.")
    ] = None,
    name: Annotated[str | None, typer.Option(help="Name of the shoe. Default: that of the file or robot.")] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")] = Path("out/shoe"),
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Build a printable tactile shoe for a robot's foot, and the layout of its taxels.

    Writes the printable part (shoe_<side>.stl, .step, .3mf), its pad, layout_<side>.json, a drawing, a picture, the
    bill of parts (parts.csv) and check.json. Exit code 1 if a check does not hold.

    Example: plantar shoe foot.stl -o out/shoe

    Example: plantar shoe robot.xml --body left_foot --side left

    Example: plantar shoe --robot h1 --set material=PETG --set rim_height=16 --json
    """
    from plantar.atomic import output_folder
    from shoes import build_shoe, export_shoe

    if sum(v is not None for v in (foot, robot, dimensions)) != 1:
        raise InputError(
            "give one of: a file of the foot (plantar shoe FOOT.stl), --robot NAME, or --dimensions LENGTHxWIDTH"
        )
    for option, value, allowed in (
        ("--side", side, ("left", "right", "both")),
        ("--mesh-side", mesh_side, (None, "left", "right")),
        ("--unit", unit, (None, "m", "cm", "mm", "in")),
        ("--up", up, (None, "x", "-x", "y", "-y", "z", "-z")),
        ("--forward", forward, (None, "x", "-x", "y", "-y")),
    ):
        if value not in allowed:
            raise InputError(f"{option} is '{value}'; allowed: {', '.join(a for a in allowed if a)}")
    used = _shoe_parameters(parameters, settings or [])
    if robot is not None:
        shape, robot_taxels = _robot_foot(robot)
        taxels = robot_taxels if taxels is None else taxels
    elif dimensions is not None:
        shape = _box_foot(dimensions)
    else:
        assert foot is not None
        shape = _foot_of_file(foot, body, used, mesh_side=mesh_side, unit=unit, up=up, forward=forward, sole_z=sole_z)
    with output_folder(output) as folder, _progress() as tell:
        build = build_shoe(
            shape,
            side=cast(Any, side),
            cell_area=cell_area,
            taxels=taxels,
            overhang=overhang,
            parameters=used,
            name=name,
            layout_only=layout_only,
            progress=lambda fraction, text: tell(0.6 * fraction, text),
        )
        report = export_shoe(build, folder, progress=lambda fraction, text: tell(0.6 + 0.4 * fraction, text))
    summary = report.as_dict() | {"files": [str(output / name) for name in report.files]}
    if as_json:
        print(json.dumps(summary))
    else:
        _print_shoe(summary)
    failed = [
        f"{which}: {c['name']} is {c['value']}, allowed {c['allowed']}"
        for which, one in summary.get("sides", {}).items()
        for c in one["checks"]
        if not c["holds"]
    ]
    for line in failed:
        print(f"plantar: check does not hold: {line}", file=sys.stderr)
    if failed:
        raise typer.Exit(1)


def _shoe_parameters(path: Path | None, settings: list[str]) -> Any:
    """The shoe's parameters: defaults, what a file changes of them, and what single settings change of that."""
    from shoes import ShoeParameters, read_parameters

    values = (ShoeParameters() if path is None else read_parameters(path)).as_dict()
    for setting in settings:
        name, sign, text = setting.partition("=")
        name, text = name.strip(), text.strip()
        if not sign or not text:
            raise InputError(f"--set '{setting}' is not NAME=VALUE, for example --set rim_height=16")
        try:
            values[name] = float(text)
        except ValueError:
            values[name] = text
    return ShoeParameters.from_mapping(values)


def _box_foot(text: str) -> Any:
    """The foot of --dimensions LxW or LxWxR in mm."""
    from shoes import foot_from_dimensions

    try:
        values = [float(v) / 1000.0 for v in text.lower().split("x")]
    except ValueError:
        values = []
    if len(values) not in (2, 3):
        raise InputError(f"--dimensions is '{text}'; allowed: LENGTHxWIDTH or LENGTHxWIDTHxRADIUS in mm, as 241x138x20")
    radius = values[2] if len(values) == 3 else min(0.010, 0.25 * abs(values[1]))
    return foot_from_dimensions("foot", length=values[0], width=values[1], corner_radius=radius)


def _foot_of_file(
    path: Path,
    body: str | None,
    parameters: Any,
    *,
    mesh_side: str | None,
    sole_z: float | None,
    up: str | None,
    **options: Any,
) -> Any:
    """The foot of a mesh, a robot's model or a drawing, by the file's ending."""
    from dataclasses import replace

    from shoes.foot.foot_mesh import foot_from_mesh, foot_from_triangles
    from shoes.foot.outline_file import OUTLINE_FORMATS, foot_from_drawing
    from shoes.foot.robot_model import MODEL_FORMATS, read_foot_body

    kind = path.suffix.lower()
    if kind in OUTLINE_FORMATS:
        for option, value in (("--body", body), ("--sole-z", sole_z), ("--up", up)):
            if value is not None:
                raise InputError(f"{option} is for meshes and models; {path} is the outline of a sole")
        return foot_from_drawing(path, mesh_side=cast(Any, mesh_side or "left"), **options)
    options |= {"up": up, "sole_z": sole_z, "sole_band": parameters.sole_band, "patch_gap": parameters.patch_gap}
    if kind in MODEL_FORMATS:
        found = read_foot_body(path, body)
        seen = cast(Any, mesh_side or found.side or "left")
        where = f"{path}, body '{body}'"
        shape = foot_from_triangles(path.stem, found.triangles, where=where, file_unit="m", mesh_side=seen, **options)
        return replace(shape, notes=(found.note, *shape.notes))
    if body is not None:
        raise InputError(f"--body is for a robot's model ({', '.join(MODEL_FORMATS)}); {path} is none")
    return foot_from_mesh(path, mesh_side=cast(Any, mesh_side or "left"), **options)


def _robot_foot(name: str) -> tuple[Any, int | None]:
    """The left foot of a built-in robot and the number of taxels its robot file asks for."""
    from importlib.util import find_spec

    from plantar.structured_text import read_toml
    from shoes import foot_from_dimensions

    spec = find_spec("sim")
    folders = [Path(p) / "robots" for p in (spec.submodule_search_locations or [])] if spec else []
    files = {f.parent.name: f for folder in folders for f in sorted(folder.glob("*/robot.toml"))}
    if name not in files:
        raise InputError(f"unknown robot '{name}'; allowed: {', '.join(sorted(files))}")
    try:
        source = read_toml(files[name], RobotError, f"robot file {files[name]}")
        facts = source["foot"]
        shape = foot_from_dimensions(
            name,
            length=float(facts["foot_length"]),
            width=float(facts["foot_width"]),
            sole_center=(float(facts["sole_center"][0]), float(facts["sole_center"][1])),
            corner_radius=float(facts["corner_radius"]),
            mass=_robot_mass(source),
        )
        taxels = facts.get("taxels")
    except (ValueError, LookupError, TypeError) as error:
        raise RobotError(f"{files[name]}: table [foot] cannot be used ({error!r})") from None
    return shape, None if taxels is None else int(taxels)


def _robot_mass(source: dict[str, Any]) -> float | None:
    """Mass in kg that a robot's file states."""
    mass = source.get("biped", {}).get("total_mass")
    return None if mass is None else float(mass)


def _print_shoe(summary: dict[str, Any]) -> None:
    """The shoe's figures for people."""
    for note in summary["notes"]:
        print(f"  {note}")
    print(
        f"{summary['taxels']} taxels of {summary['cell_area_mm2']:g} mm^2 cover "
        f"{100 * summary['covered_area_ratio']:.0f} % of the sole; overhang {summary['overhang_mm']:g} mm; at most "
        f"{summary['whole_taxels_bound']} whole ones fit there (proven)"
    )
    if "sides" in summary:
        size = " x ".join(f"{v:.1f}" for v in summary["size_mm"])
        print(
            f"{size} mm, {summary['volume_cm3']:.1f} cm^3, {summary['mass_g']:.0f} g printed, "
            f"{summary['worn_mass_g']:.0f} g worn, {summary['print_hours']:g} h to print, thinnest wall "
            f"{summary['min_wall_mm']:g} mm, {'watertight' if summary['watertight'] else 'NOT watertight'}; "
            f"{'all checks hold' if summary['holds'] else 'A CHECK DOES NOT HOLD'}"
        )
    for name in summary["files"]:
        print(f"  {name}")


@app.command()
def analyze(
    recording: Annotated[
        Path | None,
        typer.Argument(help="The recording or footprint image; recognised from its content.", show_default=False),
    ] = None,
    compare: Annotated[
        tuple[Path, Path] | None,
        typer.Option("--compare", metavar="A B", help="Two recordings to put side by side instead of one."),
    ] = None,
    format: Annotated[
        str | None, typer.Option(help="Name of the format, where recognition fails: see plantar list formats.")
    ] = None,
    layout: Annotated[
        Path | None,
        typer.Option(help="Layout file to use instead of the format's own geometry; mirrored for the other foot."),
    ] = None,
    unit: Annotated[
        str | None, typer.Option(help="Unit of the values, instead of the file's: kPa, N/cm2, mmHg, psi, N, raw, ...")
    ] = None,
    rate: Annotated[float | None, typer.Option(help="Frames a second, instead of the file's.")] = None,
    side: Annotated[str | None, typer.Option(help="Which foot a file of one foot holds: left or right.")] = None,
    mm_per_pixel: Annotated[float | None, typer.Option(help="Footprint images: size of a pixel in mm.")] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")] = Path("out/analysis"),
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Measure feet: recordings of insoles, platforms, robot soles and force plates, or an image of a footprint.

    Finds the steps and writes metrics.json, steps.csv (a row a step), regions.csv, figures (PNG and SVG) and
    report.html, which opens anywhere. What had to be assumed stands in "warnings"; what each measure means in
    docs/metrics.md.

    Example: plantar analyze walk.asc -o out/walk

    Example: plantar analyze out/demo/run.mcap --json

    Example: plantar analyze table.csv --layout insole.json --unit kPa

    Example: plantar analyze scan.png --mm-per-pixel 0.5

    Example: plantar analyze --compare before.mcap after.mcap -o out/both
    """
    from plantar.formats import ReadOptions

    if (recording is None) == (compare is None):
        raise InputError("give either one recording or --compare A B: plantar analyze walk.asc")
    if side not in (None, "left", "right"):
        raise InputError(f"--side is '{side}'; allowed: left, right")
    options = ReadOptions(unit=unit, rate_hz=rate, side=cast(Any, side))
    with _progress() as tell:
        if compare is not None:
            from gait.analysis.compare import compare_recordings

            if mm_per_pixel is not None:
                raise InputError("--mm-per-pixel is for footprint images; --compare takes recordings over time")
            result = compare_recordings(*compare, output, format, layout, tell, options=options)
        else:
            from gait.analysis.analyse import analyse_recording

            result = analyse_recording(
                cast(Path, recording), output, format, layout, tell, options=options, mm_per_pixel=mm_per_pixel
            )
    if as_json:
        print(json.dumps(result))
        return
    for name, metrics in {"A": result["a"], "B": result["b"]}.items() if compare is not None else [("", result)]:
        _print_analysis(metrics, name)
    for name in result["files"]:
        print(f"  {name}")


def _print_analysis(metrics: dict[str, Any], name: str) -> None:
    """The main figures of an analysis for people, and what was assumed on stderr."""
    rate = "" if metrics["rate_hz"] is None else f" at {metrics['rate_hz']:.6g} Hz"
    print(f"{name + ': ' if name else ''}{metrics['format']}: {metrics['frames']} frame(s){rate}")
    for side, foot in metrics["feet"].items():
        if "footprint" in foot:
            print_, arch = foot["footprint"], foot["footprint"]["arch_index"]
            length = "" if print_["length_m"] is None else f"{1e3 * print_['length_m']:.0f} mm long, "
            print(f"  {side} footprint: {length}arch index {'-' if arch is None else f'{arch:.3f}'}")
            continue
        contact = foot["measures"]["contact_time_s"]["mean"]
        print(f"  {side}: {foot['steps']} complete steps" + (f", contact {contact:.3f} s" if contact else ""))
    cadence = metrics["gait"].get("cadence_steps_per_min")
    if cadence is not None:
        print(f"  cadence {cadence:.1f} steps/min")
    for warning in metrics["warnings"]:
        print(f"  note: {warning}", file=sys.stderr)


@app.command()
def sim(
    scene: Annotated[str, typer.Argument(help="A built-in scene (plantar list scenes) or a scene .toml file.")],
    robot: Annotated[
        str | None, typer.Option(help="Robot to use instead of the scene's: a built-in name or a robot .toml file.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of the sensor noise and of what the scene leaves to chance.")] = 0,
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a value of the scene; repeatable.")
    ] = None,
    record: Annotated[Path | None, typer.Option(help="Write a recording: an .mcap file that Foxglove reads.")] = None,
    video: Annotated[Path | None, typer.Option(help="Write a video: an .mp4 file (slow without a GPU).")] = None,
    plot: Annotated[Path | None, typer.Option(help="Folder for figures: balance, plane and feet.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Run one scenario in MuJoCo and judge it by the true contact forces.

    The controller reads taxels, encoders and IMU only; the judge reads the simulator. Exit code 1 if the robot fell or
    did not do what was planned.

    Example: plantar sim flat --robot h1 --plot out/flat

    Example: plantar sim push --seed 3 --set feedback=false --json
    """
    if seed < 0:
        raise InputError(f"--seed is {seed}; allowed: 0 or more")
    if record is not None and record.suffix != ".mcap":
        raise InputError(f"--record {record} needs a name that ends in .mcap")
    if video is not None and video.suffix != ".mp4":
        raise InputError(f"--video {video} needs a name that ends in .mp4")
    if video is not None:
        os.environ.setdefault("MUJOCO_GL", "egl")
    _need("sim", *_SIM)
    from plantar.atomic import output_folder, parent_folder
    from sim.figures.run_figure import plot_run
    from sim.run.runner import run_scene
    from sim.run.scene import load_scene

    loaded = load_scene(scene, settings or [], robot)
    with ExitStack() as stack:
        folder = None if plot is None else stack.enter_context(output_folder(plot))
        for file in (record, video):
            if file is not None:
                stack.enter_context(parent_folder(file))
        kept = folder / "run.mcap" if record is None and folder is not None else record
        with _progress() as tell:
            summary = run_scene(loaded, seed, record=kept, video=video, progress=tell)
        if folder is not None and kept is not None:
            figures = [str(cast(Path, plot) / f.name) for f in plot_run(kept, folder)]
            summary["figures"] = figures
            if record is None:
                kept.unlink()
    if as_json:
        print(json.dumps(summary))
    else:
        _print_run(summary)
    if not summary["completed"]:
        raise typer.Exit(1)


def _print_run(summary: dict[str, Any]) -> None:
    """A run's figures for people."""
    end = "completed" if summary["completed"] else ("FELL" if summary["fell"] else "NOT COMPLETED")
    print(
        f"{summary['scene']} with {summary['robot']}, seed {summary['seed']}: {end}, {summary['steps_taken']} of "
        f"{summary['steps_planned']} steps in {summary['sim_time_s']:.1f} s"
    )
    for reason in summary["reasons"]:
        print(f"  not completed, {reason['criterion'].replace('_', ' ')}: {reason['text']}")
    margin = summary["zmp_margin_min_m"]
    print(
        f"  largest tilt {summary['tilt_max_deg']:.2f} deg, smallest true ZMP margin "
        f"{'-' if margin is None else f'{1e3 * margin:.1f} mm'}"
    )
    if summary["impacts_N"]:
        impacts = sorted(summary["impacts_N"])
        print(f"  landing impact: median {impacts[len(impacts) // 2]:.0f} N, largest {impacts[-1]:.0f} N")
    final = summary["final"]
    print(
        f"  at the end {1e3 * final['position_error_m']:.1f} mm and {final['heading_error_deg']:.2f} deg off the plan, "
        f"tilted by {final['tilt_deg']:.2f} deg, CoM at {final['height_m']:.3f} m; "
        f"estimated CoM off by at most {1e3 * max(summary['estimate']['com_error_max_m']):.1f} mm"
    )
    held = summary["torque_limit"]
    most = sorted(held["joints"].items(), key=lambda joint: -joint[1])[:3]
    joints = ", ".join(f"{name} {100 * share:.1f} %" for name, share in most)
    print(
        f"  a standing foot slipped by at most {1e3 * summary['slip_max_m']:.1f} mm; joints at their torque limit in "
        f"{100 * held['share_of_ticks']:.1f} % of the ticks{f' ({joints})' if joints else ''}"
    )
    speed = summary["joint_speed"]
    if speed is None:
        print("  joint speeds are not limited: the robot's file gives no [servo] velocity_limits")
    else:
        print(f"  fastest joint: {speed['joint']}, {speed['share_of_limit']:.2f} of its speed limit")
    late = summary["out_of_reach_since_s"]
    if late is not None:
        print(
            f"  from {late:.2f} s on the legs did not reach what was asked of them: walk lower (--set crouch=0.05) or "
            "take shorter steps"
        )
    balance = summary.get("balance", {})
    if balance.get("pushes"):
        print(
            f"  recovered from {balance['recovered']} of {len(balance['pushes'])} pushes, which moved the true ZMP by "
            f"up to {1e3 * balance['zmp_off_max_m']:.0f} mm"
        )
    zmps = balance.get("skin_against_force_torque", {})
    if zmps.get("rms_m") is not None:
        print(
            f"  ZMP of the skin against that of the ankles: {1e3 * zmps['rms_m']:.2f} mm RMS, "
            f"{1e3 * zmps['max_m']:.1f} mm at most"
        )
    tick = summary["control_us"]
    print(
        f"  {summary['real_time_factor']:.1f} x real time; control tick {tick['p50']:.0f} us (median), "
        f"{tick['p99']:.0f} us (99 %)"
    )
    for name in summary.get("figures", []):
        print(f"  {name}")


@app.command()
def sweep(
    scene: Annotated[str, typer.Argument(help="A built-in scene (plantar list scenes) or a scene .toml file.")],
    grid: Annotated[
        list[str] | None, typer.Option(metavar="KEY=A,B,C", help="Values to try of one setting; repeatable.")
    ] = None,
    seeds: Annotated[int, typer.Option(help="Seeds of each grid point.")] = 1,
    first_seed: Annotated[
        int, typer.Option(help="The first of them; for figures on seeds that nothing was tuned on.")
    ] = 0,
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's.")] = None,
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="A setting of all runs; repeatable.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes on this machine. Default: one a core.")] = 0,
    scheduler: Annotated[str | None, typer.Option(help="Address of a Dask scheduler, tcp://host:8786.")] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")] = Path("out/sweep"),
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Run a scene over a grid of settings and seeds, and count what was completed.

    Writes results.csv (a row a run, as it ends) and a figure. A sweep that was stopped, by Ctrl-C or because its
    workers went away (exit code 1), goes on where it was when the same command is given again; seeds and values of the
    grid may be added.

    Example: plantar sweep push --grid impulse=20,30 --grid feedback=true,false --seeds 20 -o out/push

    Example: plantar sweep stones --seeds 10 --first-seed 1000 -o out/stones
    """
    os.environ.setdefault(
        "MUJOCO_GL", "disable"
    )  # MuJoCo starts a process to look for a display; nothing is drawn here
    _need("sim", *_SIM)
    from sim.sweep import Sweep, SweepStopped, run_sweep

    wanted = Sweep.from_texts(scene, grid or [], seeds, robot, settings or [], first_seed)
    try:
        with _progress() as tell, _no_second_interrupt():
            count = workers or os.cpu_count() or 1
            result = run_sweep(wanted, output, workers=count, scheduler=scheduler, progress=tell)
    except SweepStopped as stop:
        raise Terminated(stop.number, str(stop)) from None
    if as_json:
        print(json.dumps(result))
        return
    for point in result["points"]:
        name = " ".join(f"{k}={v}" for k, v in point["settings"].items()) or scene
        why = ", ".join(f"{criterion.replace('_', ' ')} {count}" for criterion, count in point["reasons"].items())
        print(f"{name}: {point['completed']} of {point['runs']} completed{f'; failed by: {why}' if why else ''}")
        for error in dict.fromkeys(point["errors"]):
            print(f"plantar: {name}: {point['errors'].count(error)} run(s) could not be: {error}", file=sys.stderr)
    for name in result["files"]:
        print(f"  {name}")


@contextmanager
def _no_second_interrupt() -> Iterator[None]:
    """Ignore further signals after the one that stopped something: its line is still to be printed."""
    try:
        yield
    except KeyboardInterrupt:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        raise


@app.command()
def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for everything that is made.")] = Path("out"),
    seed: Annotated[int, typer.Option(help="Seed of the sensor noise.")] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """The main job in one go: build the H1's tactile shoes, walk a 12 cm beam on what they feel, analyse the walk.

    The simulator wears the layouts that the shoe builder has just written, and the analysis reads the recording that
    the simulator has just made.

    Example: plantar demo -o out
    """
    _need("sim", *_SIM)
    from gait.analysis.analyse import analyse_recording
    from plantar.atomic import output_folder
    from plantar.layouts.layout_file import read_layout
    from shoes import ShoeParameters, build_shoe, export_shoe
    from sim.figures.run_figure import plot_run
    from sim.run.runner import run_scene
    from sim.run.scene import load_scene

    with output_folder(output) as folder, _progress() as tell:
        for name in ("shoe", "walk", "analysis"):
            (folder / name).mkdir()
        shape, taxels = _robot_foot("h1")
        build = build_shoe(
            shape,
            side="both",
            taxels=taxels,
            parameters=ShoeParameters(),
            progress=lambda share, text: tell(0.3 * share, f"shoe: {text}"),
        )
        report = export_shoe(
            build, folder / "shoe", progress=lambda share, text: tell(0.3 + 0.2 * share, f"shoe: {text}")
        ).as_dict()
        walk = run_scene(
            load_scene("beam"),
            seed,
            layouts={s: read_layout(folder / "shoe" / f"layout_{s}.json") for s in ("left", "right")},
            record=folder / "walk" / "run.mcap",
            progress=lambda share, text: tell(0.5 + 0.3 * share, f"walk: {text}"),
        )
        plot_run(folder / "walk" / "run.mcap", folder / "walk")
        write_text(folder / "walk" / "summary.json", json.dumps(walk, indent=1) + "\n")
        analysis = analyse_recording(
            folder / "walk" / "run.mcap",
            folder / "analysis",
            progress=lambda share, text: tell(0.8 + 0.2 * share, f"analysis: {text}"),
        )
        files = sorted(str(output / p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    done = bool(walk["completed"]) and bool(report["holds"])
    if as_json:
        print(json.dumps({"completed": done, "shoe": report, "walk": walk, "analysis": analysis, "files": files}))
    else:
        print(
            f"shoe: {report['taxels']} taxels, {report['mass_g']:.0f} g, "
            f"{'all checks hold' if report['holds'] else 'A CHECK DOES NOT HOLD'}"
        )
        _print_run(walk)
        steps = {side: foot["steps"] for side, foot in analysis["feet"].items()}
        print(f"analysis: {steps.get('left', 0)} left and {steps.get('right', 0)} right complete steps")
        print("made:")
        for name in files:
            print(f"  {name}")
        print(f"open {output / 'analysis' / 'report.html'} in a browser")
    if not done:
        raise typer.Exit(1)


def _need(extra: str, *libraries: str) -> None:
    """Raise a clear error where an optional library is missing or cannot be loaded."""
    from importlib import import_module

    from plantar.optional_library import optional_library

    for library in libraries:
        with optional_library(library, extra):
            import_module(library)


@app.command(name="list")
def list_(
    what: Annotated[str, typer.Argument(help="robots, scenes, formats or settings.")],
    name: Annotated[
        str | None, typer.Argument(help="settings: a table or a setting, such as estimator or balance.dcm_gain.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """List what there is: robots to walk, scenes to run, recording formats to analyse, settings to change.

    Each setting is shown with its default, unit and range; `--set` and `--grid` take its dotted name.

    Example: plantar list formats

    Example: plantar list settings estimator
    """
    if name is not None and what != "settings":
        raise InputError(f"'list {what}' takes no name, got '{name}'; allowed: plantar list settings NAME")
    if what == "settings":
        _need("mujoco", "sim")
        from sim.run.setting_list import settings_listed

        _print_settings(settings_listed(name), as_json)
        return
    if what == "formats":
        from plantar.formats import formats

        found = {f.name: f"{f.title} ({', '.join(f.suffixes)})" for f in formats().values()}
    elif what == "robots":
        found = _described("robots/*/robot.toml", lambda path: path.parent.name)
    elif what == "scenes":
        found = _described("scenes/*.toml", lambda path: path.stem)
    else:
        raise InputError(f"cannot list '{what}'; allowed: robots, scenes, formats, settings")
    if as_json:
        print(json.dumps({what: [{"name": name, "description": text} for name, text in found.items()]}))
        return
    width = max((len(name) for name in found), default=0)
    for name, text in found.items():
        print(f"{name:{width}}  {text}".rstrip())


def _print_settings(found: Mapping[str, Setting], as_json: bool) -> None:
    """Print settings, a line each and what they mean below, or as one JSON object."""
    if as_json:
        print(json.dumps({"settings": [{**told._asdict(), "name": full} for full, told in found.items()]}))
        return
    for full, told in found.items():
        unit = f" {told.unit}" if told.unit not in ("", "1") else ""
        print(f"{full} = {told.default}{unit}  ({told.allowed})")
        for line in textwrap.wrap(told.meaning, 100):
            print(f"    {line}")


def _described(pattern: str, name: Callable[[Path], str]) -> dict[str, str]:
    """Names of the simulator's TOML files and the "title" or "description" each gives; the simulator is not loaded."""
    from importlib.util import find_spec

    from plantar.structured_text import read_toml

    spec = find_spec("sim")
    found: dict[str, str] = {}
    for folder in (spec.submodule_search_locations or []) if spec else []:
        for path in sorted(Path(folder).glob(pattern)):
            try:
                facts = read_toml(path, InputError, f"file {path}")
            except InputError:
                facts = {}
            text = next((str(facts[k]) for k in ("title", "description", "about") if k in facts), "")
            found[name(path)] = text.strip().split("\n")[0]
    return found


@app.command()
def bench(
    what: Annotated[str, typer.Argument(help="kernels, contact or all.")] = "all",
    layout: Annotated[
        Path | None,
        typer.Option(help="contact: layout file of the sole. Default: 250 x 155 mm with taxels of 691 mm^2."),
    ] = None,
    stress: Annotated[
        bool, typer.Option("--stress", help="kernels: throw readings at every function and check what comes back.")
    ] = False,
    readings: Annotated[int, typer.Option(help="--stress: how many readings.")] = 1_000_000,
    seed: Annotated[int, typer.Option(help="--stress: seed of what is left to chance.")] = 0,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")] = Path("out/bench"),
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Measure run time against error, and write tables, figures and bench.json.

    kernels: the perception's kernels beside scipy, shapely, cv2 and approximations, with the error against exact
    references; under 2 minutes. With --stress instead a million odd readings for every function of the perception:
    exit code 1 if one raises, hangs, gives NaN or leaves its bound.

    contact: ways to simulate a sole's contact and its taxels, against MuJoCo's exact contact wrench. Exit code 1 if the
    chosen model is not as right as it must be (centre of pressure within 2 mm, tip-over edge within 1 mm).

    Example: plantar bench kernels -o out/bench

    Example: plantar bench kernels --stress --readings 20000 --json
    """
    from plantar.atomic import output_folder, write_text

    if what not in ("kernels", "contact", "all"):
        raise InputError(f"cannot measure '{what}'; allowed: kernels, contact, all")
    if stress:
        if what != "kernels":
            raise InputError(f"--stress is for kernels, not '{what}': plantar bench kernels --stress")
        _bench_stress(readings, seed, as_json)
        return
    result: dict[str, Any] = {}
    with output_folder(output) as folder, _progress() as tell:
        share = 0.5 if what == "all" else 1.0
        if what in ("kernels", "all"):
            result["kernels"] = _bench_kernels(folder, lambda f, text: tell(share * f, text))
        if what in ("contact", "all"):
            result["contact"] = _bench_contact(folder, layout, lambda f, text: tell(1.0 - share + share * f, text))
        result["files"] = [str(output / name) for part in list(result.values()) for name in part.pop("files")]
        result["files"].append(str(output / "bench.json"))
        write_text(folder / "bench.json", json.dumps(result, indent=1) + "\n")
    if as_json:
        print(json.dumps(result))
    else:
        if "kernels" in result:
            _print_kernels(result["kernels"])
        if "contact" in result:
            _print_contact(result["contact"])
        for name in result["files"]:
            print(f"  {name}")
    if "contact" in result and not result["contact"]["holds"]:
        print("plantar: the chosen contact model is not as right as it must be", file=sys.stderr)
        raise typer.Exit(1)


def _bench_kernels(folder: Path, tell: Callable[[float, str], None]) -> dict[str, Any]:
    """Compare the perception's kernels with other routes; gives results, targets and the names of the files."""
    from plantar.bench.report import compare_kernels, targets, write_kernel_report

    _need("sim", "scipy", "cv2")
    results = compare_kernels(progress=tell)
    return {
        "results": [r.as_dict() for r in results],
        "targets": [t.as_dict() for t in targets(results)],
        "files": write_kernel_report(folder, results),
    }


def _print_kernels(result: dict[str, Any]) -> None:
    """The kernels' medians and errors, and what of the wanted is met, for people."""
    kernel = ""
    for row in result["results"]:
        if row["kernel"] != kernel:
            kernel = row["kernel"]
            print(f"{kernel:58}{'median us':>12}{'spread':>8}{'ratio':>9}{'error':>10}")
        error = "-" if row["error"] is None else f"{row['error']:.1e}"
        route = f"  {row['size']}: {row['route']}"
        print(f"{route:58}{row['median_us']:>12.2f}{row['spread']:>8.0%}{row['ratio']:>9.1f}{error:>10}")
    print("wanted and reached, at the worst size:")
    for target in result["targets"]:
        sign = ">=" if target["at_least"] else "<="
        line = f"{target['what']}: {target['figure']:.3g} {target['unit']}".rstrip()
        wanted = f"wanted {sign} {target['wanted']:g}; {target['where']}"
        print(f"  {'met    ' if target['met'] else 'NOT MET'} {line} ({wanted})")


def _bench_stress(readings: int, seed: int, as_json: bool) -> None:
    """Run the stress run, print what it saw, and exit with 1 if something failed."""
    from plantar.bench.stress.stress_run import stress

    with _progress() as tell:
        result = stress(readings, seed, progress=tell)
    if as_json:
        print(json.dumps(result.as_dict()))
    else:
        print(f"{'function':66}{'readings':>10}{'worst':>10}{'bound':>10}{'failures':>10}")
        for name, tested in sorted(result.functions.items()):
            print(f"{name:66}{tested.readings:>10}{tested.worst:>10.1e}{tested.bound:>10.1e}{tested.failures:>10}")
            for example in tested.examples:
                print(f"    {example}")
        print(f"{result.readings} readings in {result.seconds:.0f} s: {result.failures} failures")
        print(f"every function met {result.least} readings or more")
    if result.failures:
        print(f"plantar: {result.failures} failures in {result.readings} readings", file=sys.stderr)
        raise typer.Exit(1)


def _bench_contact(folder: Path, layout: Path | None, tell: Callable[[float, str], None]) -> dict[str, Any]:
    """Compare contact models; gives the rows, the parameters and the names of the files."""
    _need("sim", *_SIM)
    from plantar import hex_layout, read_layout
    from sim.contact_models import compare_contact_models, holds, study_contact_parameters, write_contact_report

    if layout is None:
        sole = hex_layout([[-0.125, -0.0775], [0.125, -0.0775], [0.125, 0.0775], [-0.125, 0.0775]])
    else:
        sole = read_layout(layout)
    rows = compare_contact_models(sole, progress=lambda f, text: tell(0.9 * f, text))
    parameters = study_contact_parameters(sole, progress=lambda f, text: tell(0.9 + 0.1 * f, text))
    return {
        "chosen": rows[0].name,
        "holds": holds(rows[0]),
        "models": [r.as_dict() for r in rows],
        "parameters": [p.as_dict() for p in parameters],
        "files": write_contact_report(folder, sole, rows, parameters),
    }


def _print_contact(result: dict[str, Any]) -> None:
    """The comparison's main figures for people."""
    print(f"{'contact model':24}{'CoP max mm':>12}{'edge mm':>10}{'step us':>10}{'read us':>10}")
    for row in result["models"]:
        edges = [row["edge_x_mm"], row["edge_y_mm"]]
        edge = "-" if None in edges else f"{round(max(edges, key=abs), 2) + 0.0:.2f}"
        cop = "-" if row["cop_max_mm"] is None else f"{row['cop_max_mm']:.2f}"
        print(f"{row['name']:24}{cop:>12}{edge:>10}{row['step_us']:>10.1f}{row['read_us']:>10.1f}")
    print(f"chosen: {result['chosen']}, {'holds' if result['holds'] else 'DOES NOT HOLD'} what is required")


@contextmanager
def _progress() -> Iterator[Callable[[float, str], None]]:
    """A progress bar on stderr; gives the callback that moves it. Silent where stderr is no terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("", total=1.0)
        yield lambda fraction, text: bar.update(task, completed=fraction, description=text)


def _run_app() -> int:
    """Run the command that the arguments name; a wrong argument is an error of one line."""
    usage_error = cast(type[Exception], typer.BadParameter.__base__)  # typer exports it under no name of its own
    command = typer.main.get_command(app)
    try:  # typer's own way to run it would print several lines, and end with 1 where nobody reads stdout
        with command.make_context("plantar", sys.argv[1:]) as context:
            command.invoke(context)
        return 0
    except typer.Exit as end:
        return int(end.exit_code)
    except typer.Abort:
        raise KeyboardInterrupt from None
    except usage_error as error:
        text = cast(Any, error).format_message()
        if "\n" in text:  # `plantar` alone: the help
            print(text, file=sys.stderr)
            return BAD_INPUT
        place = getattr(getattr(error, "ctx", None), "command_path", "plantar")
        raise InputError(f"{text.rstrip('.')}; see {place} --help") from None


def main() -> None:
    """Entry point of the console script."""
    sys.exit(run(_run_app))


if __name__ == "__main__":
    main()
