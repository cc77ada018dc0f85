"""The command line: `plantar <command>`. Heavy libraries are imported inside the command that needs them."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any, cast

import typer
from typer import Argument, Option

from plantar import __version__
from plantar.console.command import Json, Output, end_command, file_lines, run_command
from plantar.console.ending import Terminated, ignore_further_interrupts, run
from plantar.console.option_group import with_option_groups
from plantar.console.progress import part_of, progress_bar
from plantar.errors import InputError, RobotError
from plantar.optional_library import need_libraries
from plantar.shoes.order import FootSource, ShoeOrder
from plantar.sides import SIDES
from plantar.sim.libraries import LIBRARIES

__all__ = ["app", "main"]

app = typer.Typer(
    name="plantar",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"plantar {__version__}")
        raise typer.Exit


@app.callback()
def _commands(
    version: Annotated[
        bool, Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Plantar skin and gait: build a tactile shoe, walk a robot on plantar feedback, analyse recordings."""


@app.command(short_help="Build a printable tactile shoe for a foot, and its taxel layout.")
@with_option_groups
def shoe(
    source: FootSource,
    order: ShoeOrder,
    foot: Annotated[
        Path | None,
        Argument(
            metavar="FOOT",
            help="Mesh of the foot (.stl .obj .ply .off .dae .3mf .step), robot's model (.xml .urdf, with --body), "
            "or outline of its sole (.dxf .svg .geojson).",
            show_default=False,
        ),
    ] = None,
    parameters: Annotated[
        Path | None, Option(help="JSON or TOML file with parameters; their names are in docs/shoes.md.")
    ] = None,
    settings: Annotated[
        list[str] | None, Option("--set", metavar="NAME=VALUE", help="Change one parameter; repeatable.")
    ] = None,
    preview: Annotated[
        bool, Option("--preview", help="Only draw the foot with the axes that were found (preview.png), in 3 s.")
    ] = False,
    output: Output = Path("out/shoe"),
    as_json: Json = False,
) -> None:
    """Build a printable tactile shoe for a robot's foot, and the layout of its taxels.

    Writes the printable part (shoe_<side>.stl, .step, .3mf), its pad, layout_<side>.json, a drawing, a picture, the
    bill of parts (parts.csv), how it is put together (assembly.html) and check.json. Exit code 1 if a check does not
    hold.

    Example: plantar shoe foot.stl -o out/shoe

    Example: plantar shoe robot.xml --body left_foot --side left

    Example: plantar shoe --robot h1 --set material=PETG --set rim_height=16 --json

    Example: plantar shoe foot.stl --coupon -o out/coupon

    Example: plantar shoe outline_of_my_foot.svg --insole 6 --set robot_mass=72 -o out/insole
    """
    from plantar.atomic import output_folder
    from plantar.shoes import ShoeParameters, export_shoe, read_parameters
    from plantar.shoes.foot.source import read_foot
    from plantar.shoes.ordered import build_ordered, coupons_text, write_ordered_coupons
    from plantar.shoes.papers.shoe_text import failed_checks, shoe_text

    if order.side not in (*SIDES, "both"):
        raise InputError(f"--side is '{order.side}'; allowed: left, right, both")
    used = (ShoeParameters() if parameters is None else read_parameters(parameters)).changed(settings or [])
    shape, taxels = read_foot(replace(source, file=foot), sole_band=used.sole_band)
    read = (foot, parameters)
    if preview:
        from plantar.shoes.papers.preview import draw_preview

        with output_folder(output, read) as folder:
            draw_preview(shape, folder / "preview.png")
        drawn = {"notes": list(shape.notes), "files": [str(output / "preview.png")]}
        end_command(drawn, as_json, "\n".join(f"  {line}" for line in (*drawn["notes"], *drawn["files"])))
        return
    with output_folder(output, read) as folder, progress_bar() as tell:
        build = build_ordered(shape, order, used, taxels, part_of(tell, 0.0, 0.6))
        if order.coupon:
            made = write_ordered_coupons(build, folder, part_of(tell, 0.6, 0.4))
            made |= {"files": [str(output / name) for name in made["files"]]}
            end_command(made, as_json, coupons_text(made))
            return
        report = export_shoe(build, folder, progress=part_of(tell, 0.6, 0.4))
    summary = report.as_dict() | {"files": [str(output / name) for name in report.files]}
    failed = failed_checks(summary)
    end_command(summary, as_json, shoe_text(summary), (f"check does not hold: {line}" for line in failed), bool(failed))


@app.command(short_help="Measure the steps of a recording, or a study of many.")
def analyze(
    recording: Annotated[
        Path | None,
        Argument(help="Recording, footprint image, or a folder of recordings (a study).", show_default=False),
    ] = None,
    participants: Annotated[
        Path | None, Option(help="Of a folder: table (CSV) of file, participant, condition and what else is known.")
    ] = None,
    compare: Annotated[
        tuple[Path, Path] | None,
        Option("--compare", metavar="A B", help="Two recordings to put side by side instead of one."),
    ] = None,
    format: Annotated[
        str | None, Option(help="Name of the format, where recognition fails: see plantar list formats.")
    ] = None,
    layout: Annotated[
        Path | None,
        Option(help="Layout file to use instead of the format's own geometry; mirrored for the other foot."),
    ] = None,
    unit: Annotated[
        str | None, Option(help="Unit of the values, instead of the file's: kPa, N/cm2, mmHg, psi, N, raw, ...")
    ] = None,
    rate: Annotated[float | None, Option(help="Frames a second, instead of the file's.")] = None,
    side: Annotated[
        str | None,
        Option(help="Which foot a file of one foot, or the first columns of a pedar file, hold: left or right."),
    ] = None,
    insole_size: Annotated[
        str | None, Option(help="Size of a pedar insole, instead of the file's: u, v, w, x, y, z, uw, vw or xw.")
    ] = None,
    plates: Annotated[
        str | None, Option(metavar="L,R", help="Which foot steps on each force plate, in order; - leaves a plate out.")
    ] = None,
    mm_per_pixel: Annotated[float | None, Option(help="Footprint images: size of a pixel in mm.")] = None,
    steps: Annotated[
        str | None, Option(help="Steps of each foot in the means: 3-14, all, or steady (without start and stop).")
    ] = None,
    begin: Annotated[float | None, Option("--from", help="Time in s before which no step is in the means.")] = None,
    end: Annotated[float | None, Option("--to", help="Time in s after which no step is in the means.")] = None,
    baseline: Annotated[
        str, Option(help="auto takes off what sensors read in swing where that is an offset; keep leaves it.")
    ] = "auto",
    events: Annotated[
        str, Option(help="own finds heel strikes and toe offs in the force; vendor takes the file's; or name a file.")
    ] = "own",
    participant: Annotated[str, Option(help="Who walks, for the report's heading.", show_default=False)] = "",
    mass: Annotated[float | None, Option(help="Mass of the body in kg: forces stand in percent of its weight.")] = None,
    foot_length: Annotated[float | None, Option(help="Length of the foot in m, for the report's heading.")] = None,
    export: Annotated[
        list[str] | None,
        Option(metavar="FORMAT", help="Write the recording in another format, too: c3d, csv or npz; repeatable."),
    ] = None,
    figures: Annotated[
        bool | None,
        Option("--figures/--no-figures", help="Whether figures and report are drawn; not with --json, else yes."),
    ] = None,
    output: Output = Path("out/analysis"),
    as_json: Json = False,
) -> None:
    """Measure feet: recordings of insoles, platforms, robot soles and force plates, or an image of a footprint.

    Finds the steps and writes metrics.json, steps.csv (a row a step), regions.csv, figures (PNG and SVG) and
    report.html, which opens anywhere. What had to be assumed stands in "warnings"; what each measure means in
    docs/metrics.md.

    Example: plantar analyze walk.asc -o out/walk

    Example: plantar analyze out/walk/run.mcap --json

    Example: plantar analyze walk.asc --participant P07 --mass 71.5

    Example: plantar analyze walk.asc --export c3d --export npz

    Example: plantar analyze table.csv --layout insole.json --unit kPa

    Example: plantar analyze scan.png --mm-per-pixel 0.5

    Example: plantar analyze --compare before.mcap after.mcap -o out/both

    Example: plantar analyze recordings/ --participants table.csv -o out/study

    Of a folder, every recording is measured; steps.csv, recordings.csv and comparison.csv hold all of them, study.html
    compares the conditions, and a study that was stopped goes on where it was.
    """
    from plantar.formats import ReadOptions
    from plantar.gait.analysis.pages.analysis_text import analysis_text

    if (recording is None) == (compare is None):
        raise InputError("give either one recording or --compare A B: plantar analyze walk.asc")
    if side not in (None, "left", "right"):
        raise InputError(f"--side is '{side}'; allowed: left, right")
    from plantar.formats.side import sides_of_plates

    options = ReadOptions(
        unit=unit,
        rate_hz=rate,
        side=cast(Any, side),
        insole_size=insole_size,
        mass_kg=mass,
        plates=sides_of_plates(plates),
    )
    from plantar.formats import is_study_folder
    from plantar.gait.analysis.analyse_one import with_layout
    from plantar.gait.analysis.options import AnalysisOptions, steps_of_text
    from plantar.gait.analysis.subject import Subject

    choices = AnalysisOptions(steps_of_text(steps), begin, end, cast(Any, baseline), events)
    subject = Subject(participant, mass, foot_length)
    if recording is not None and is_study_folder(recording):
        if export:
            raise InputError("--export is for one recording; a study's tables are CSV files")
        if subject != Subject():
            raise InputError(
                "--participant, --mass and --foot-length are for one recording: a study has --participants"
            )
        _analyze_folder(recording, participants, output, as_json, choices, with_layout(options, layout))
        return
    if participants is not None:
        raise InputError(
            "--participants is for a folder of recordings: plantar analyze recordings/ --participants table.csv"
        )
    from plantar.gait.analysis.exports import exporter

    also = exporter(export or ())
    with progress_bar() as tell:
        if compare is not None:
            if also is not None:
                raise InputError("--export is for one recording; --compare takes two")
            from plantar.gait.analysis.compare import compare_recordings

            if mm_per_pixel is not None:
                raise InputError("--mm-per-pixel is for footprint images; --compare takes recordings over time")
            result = compare_recordings(
                *compare, output, format, layout, tell, options=options, choices=choices, subject=subject
            )
        else:
            from plantar.gait.analysis.analyse_one import analyse_recording

            result = analyse_recording(
                cast(Path, recording),
                output,
                format,
                layout,
                tell,
                options=options,
                mm_per_pixel=mm_per_pixel,
                choices=choices,
                subject=subject,
                also=also,
                figures=not as_json if figures is None else figures,
            )
    parts = {"": result} if compare is None else {"A": result["a"], "B": result["b"]}
    text = "\n".join(analysis_text(metrics, name) for name, metrics in parts.items())
    end_command(result, as_json, text + file_lines(result["files"]))
    for name, metrics in () if as_json else parts.items():
        for warning in metrics["warnings"]:
            print(f"  note{f' of {name}' if name else ''}: {warning}", file=sys.stderr)


def _analyze_folder(
    folder: Path, participants: Path | None, output: Path, as_json: bool, choices: Any, options: Any
) -> None:
    """Measure a folder of recordings; a recording that cannot be read is told and is no error of the command."""
    from plantar.gait.analysis.study.run_study import run_study

    with progress_bar() as tell:
        study = run_study(folder, output, participants, tell, choices=choices, options=options)
    summary = study.summary() | {"files": list(study.files)}
    text = f"{summary['measured']} of {summary['recordings']} recordings measured, {summary['steps']} steps"
    end_command(summary, as_json, text + file_lines(study.files))
    for file, why in () if as_json else summary["errors"].items():
        print(f"  not measured: {file}: {why}", file=sys.stderr)


@app.command(short_help="Make a robot of an MJCF or URDF, ready to walk, and check it.")
def robot(
    model: Annotated[
        Path, Argument(metavar="MODEL", help="Robot's model (.xml .mjcf .urdf), or the word check.", show_default=False)
    ],
    robot_file: Annotated[Path | None, Argument(metavar="ROBOT.toml", help="After check: the robot file.")] = None,
    scene: Annotated[str | None, Option(help="check: the scene whose plan is looked at. Default: flat.")] = None,
    solid: Annotated[bool, Option("--solid", help="Build the printable shoes, too; takes half a minute.")] = False,
    output: Output = Path("out/robot"),
    as_json: Json = False,
) -> None:
    """Make a robot that walks of its model: robot.toml, a copy of the model, layouts of its shoes and a picture.

    Finds legs (two chains of five hinges or more), soles, IMU and limits, and fits height, stance, pace and servo gains
    to them. Each value in robot.toml says how it was found.

    With check, measures what would go wrong in a scene, and says which value works; exit code 1 if something would.

    Example: plantar robot my_robot.urdf -o out/mine && plantar sim flat --robot out/mine/robot.toml

    Example: plantar robot check out/mine/robot.toml --scene beam
    """
    os.environ.setdefault("MUJOCO_GL", "egl")
    need_libraries("sim", *LIBRARIES)
    if (str(model) == "check") != (robot_file is not None) or (robot_file is None and scene is not None):
        raise InputError("a robot file and --scene are for the check: plantar robot check ROBOT.toml --scene beam")
    if robot_file is None and model.suffix.lower() == ".toml":
        raise InputError(f"{model} is no model but a robot file; look at it with: plantar robot check {model}")
    if robot_file is not None:
        from plantar.sim.survey.check import check_robot

        checked = check_robot(robot_file, scene or "flat")
        end_command(checked.as_dict(), as_json, checked.text(), checked.failures, not checked.holds)
        return
    from plantar.atomic import output_folder
    from plantar.files.model_files import files_of_model
    from plantar.shoes.found_foot import shoe_for_surface
    from plantar.sim.survey.introduce import introduce

    with output_folder(output, files_of_model(model, RobotError)) as folder, progress_bar() as tell:
        made = introduce(model, folder, partial(shoe_for_surface, solid=solid, progress=part_of(tell, 0.1, 0.5)), tell)
    end_command(made.as_dict(output), as_json, made.text(output))


@app.command(short_help="Run one scenario in MuJoCo, judged by the true contacts.")
def sim(
    scene: Annotated[str, Argument(help="A built-in scene (plantar list scenes) or a scene .toml file.")],
    robot: Annotated[
        str | None, Option(help="Robot to use instead of the scene's: a built-in name or a robot .toml file.")
    ] = None,
    seed: Annotated[int, Option(help="Seed of the sensor noise and of what the scene leaves to chance.")] = 0,
    settings: Annotated[
        list[str] | None, Option("--set", metavar="KEY=VALUE", help="Change a value of the scene; repeatable.")
    ] = None,
    record: Annotated[
        Path | None, Option(help="Write a recording: an .mcap file for Foxglove and plantar view.")
    ] = None,
    video: Annotated[Path | None, Option(help="Write a video with what the soles feel: an .mp4 file.")] = None,
    plot: Annotated[Path | None, Option(help="Folder for figures: balance, plane and feet.")] = None,
    as_json: Json = False,
) -> None:
    """Run one scenario in MuJoCo and judge it by the true contact forces.

    The controller reads taxels, encoders and IMU only; the judge reads the simulator. Exit code 1 if the robot fell or
    did not do what was planned.

    Example: plantar sim flat --robot h1 --plot out/flat

    Example: plantar sim push --seed 3 --set feedback=false --json

    With --set plant=random the true robot, its sensors and the ground differ from what the controller takes them for,
    by the seed; level=1 halves that (plantar list settings plant).

    Example: plantar sim flat --set plant=random --set level=1
    """
    if seed < 0:
        raise InputError(f"--seed is {seed}; allowed: 0 or more")
    for option, file, ending in (("--record", record, ".mcap"), ("--video", video, ".mp4")):
        if file is not None and file.suffix != ending:
            raise InputError(f"{option} {file} needs a name that ends in {ending}")
    if video is not None:
        os.environ.setdefault("MUJOCO_GL", "egl")
    need_libraries("sim", *LIBRARIES)
    from plantar.sim.run.scene_kind import open_scene, run, summary_text

    loaded = open_scene(scene, settings or [], robot)
    with progress_bar() as tell:
        summary = run(loaded, seed, record=record, video=video, plot=plot, progress=tell)
    end_command(summary, as_json, summary_text(summary), failed=not summary["completed"])


@app.command(short_help="Write a page that plays one or two recordings in 3D.")
def view(
    recording: Annotated[Path, Argument(help="Recording (.mcap) of plantar sim --record, or of a robot's soles.")],
    other: Annotated[
        Path | None, Argument(help="A second recording, to see both side by side.", show_default=False)
    ] = None,
    output: Annotated[Path, Option("-o", "--output", help="The page to write, an .html file.")] = Path("out/view.html"),
    as_json: Json = False,
) -> None:
    """Write a page that plays a recording in 3D: robot, soles, CoP, forces, support polygon and footsteps.

    The page is one file for any browser and asks for no network: about 1 MB, and 60 kB for each second.

    Example: plantar view run.mcap -o view.html

    Example: plantar view feedback.mcap open_loop.mcap -o both.html
    """
    if output.suffix not in (".html", ".htm"):
        raise InputError(f"-o {output} needs a name that ends in .html")
    from plantar.atomic import parent_folder
    from plantar.viewer.page import view_text, write_page

    with parent_folder(output):
        written = write_page([recording] if other is None else [recording, other], output)
    end_command(written, as_json, view_text(written), written["warnings"])


@app.command(short_help="Run a scene over settings and seeds, or search where it breaks.")
def sweep(
    scene: Annotated[str, Argument(help="A built-in scene (plantar list scenes) or a scene .toml file.")],
    grid: Annotated[
        list[str] | None, Option(metavar="KEY=A,B,C", help="Values to try of one setting; repeatable.")
    ] = None,
    limit: Annotated[
        str | None,
        Option(metavar="KEY=FROM:TO", help="Search the value of a setting at which half of the runs are completed."),
    ] = None,
    within: Annotated[float, Option(help="Share of the limit at which its 95 % interval is narrow enough.")] = 0.1,
    random: Annotated[
        list[str] | None, Option(metavar="KEY=FROM:TO", help="Draw a setting from a range, anew a seed; repeatable.")
    ] = None,
    seeds: Annotated[
        int | None,
        Option(help="Seeds of each grid point; the most, with --limit. Default: 1, or 1000 with --limit."),
    ] = None,
    first_seed: Annotated[int, Option(help="The first of them; for figures on seeds that nothing was tuned on.")] = 0,
    robot: Annotated[str | None, Option(help="Robot to use instead of the scene's.")] = None,
    settings: Annotated[
        list[str] | None, Option("--set", metavar="KEY=VALUE", help="A setting of all runs; repeatable.")
    ] = None,
    workers: Annotated[int, Option(help="Processes on this machine. Default: one a core.", show_default=False)] = 0,
    scheduler: Annotated[str | None, Option(help="Address of a Dask scheduler, tcp://host:8786.")] = None,
    output: Output = Path("out/sweep"),
    as_json: Json = False,
) -> None:
    """Run a scene over a grid of settings and seeds, at random or towards a limit, and count what was completed.

    Writes results.csv (a row a run, as it ends) and figures. A sweep that was stopped, by Ctrl-C or because its
    workers went away (exit code 1), goes on where it was when the same command is given again; seeds and values of the
    grid may be added. A limit that is not in its range, or not known well enough, is exit code 1.

    Example: plantar sweep push --grid impulse=20,30 --grid feedback=true,false --seeds 20 -o out/push

    Example: plantar sweep stones --seeds 10 --first-seed 1000 -o out/stones

    Example: plantar sweep beam --limit width=0.02:0.2 -o out/width

    Example: plantar sweep push --random impulse=10:50 --random friction=0.3:1 --seeds 100 -o out/map
    """
    os.environ.setdefault("MUJOCO_GL", "disable")  # nothing is drawn here; MuJoCo would look for a display
    need_libraries("sim", *LIBRARIES)
    from plantar.sim.sweep import SweepStopped, plan_from_texts, run_sweep
    from plantar.sim.sweep.sweep_text import sweep_errors, sweep_text

    wanted = plan_from_texts(
        scene, grid or [], seeds, robot, settings or [], first_seed, limit=limit, within=within, random=random or []
    )
    try:
        with progress_bar() as tell, ignore_further_interrupts():
            count = workers or os.cpu_count() or 1
            result = run_sweep(wanted, output, workers=count, scheduler=scheduler, progress=tell)
    except SweepStopped as stop:
        raise Terminated(stop.number, str(stop)) from None
    failed = not all(told["reached"] for told in result.get("limits", ()))
    end_command(result, as_json, sweep_text(result, scene), () if as_json else sweep_errors(result, scene), failed)


@app.command(short_help="The main job in one go: shoe, walk on a beam, analysis.")
def demo(
    output: Annotated[Path, Option("-o", "--output", help="Folder for everything that is made.")] = Path("out"),
    seed: Annotated[int, Option(help="Seed of the sensor noise.")] = 0,
    as_json: Json = False,
) -> None:
    """The main job in one go: build the H1's tactile shoes, walk a 12 cm beam on what they feel, analyse the walk.

    The simulator wears the layouts just written, and the analysis reads the recording just made.

    Example: plantar demo -o out
    """
    need_libraries("sim", *LIBRARIES)
    from plantar.atomic import output_folder, write_text
    from plantar.gait.analysis.analyse_one import analyse_recording
    from plantar.layouts.layout_file import read_layout
    from plantar.shoes import build_shoe, export_shoe
    from plantar.shoes.foot.source import foot_of_robot
    from plantar.sim.figures.run_figure import plot_run
    from plantar.sim.run.run_text import demo_text
    from plantar.sim.run.runner import run_scene
    from plantar.sim.run.scene import load_scene

    with output_folder(output) as folder, progress_bar() as tell:
        for name in ("shoe", "walk", "analysis"):
            (folder / name).mkdir()
        foot, taxels = foot_of_robot("h1")
        build = build_shoe(foot, taxels=taxels, progress=part_of(tell, 0.0, 0.3, "shoe: "))
        report = export_shoe(build, folder / "shoe", progress=part_of(tell, 0.3, 0.2, "shoe: ")).as_dict()
        layouts = {s: read_layout(folder / "shoe" / f"layout_{s}.json") for s in SIDES}
        recording = folder / "walk" / "run.mcap"
        told = part_of(tell, 0.5, 0.3, "walk: ")
        walk = run_scene(load_scene("beam"), seed, layouts=layouts, record=recording, progress=told)
        plot_run(recording, folder / "walk")
        write_text(folder / "walk" / "summary.json", json.dumps(walk, indent=1) + "\n")
        told = part_of(tell, 0.8, 0.2, "analysis: ")
        analysis = analyse_recording(recording, folder / "analysis", progress=told)
        files = sorted(str(output / p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    done = bool(walk["completed"]) and bool(report["holds"])
    made = {"completed": done, "shoe": report, "walk": walk, "analysis": analysis, "files": files}
    end_command(made, as_json, demo_text(made, output), failed=not done)


@app.command(name="list", short_help="List robots, scenes, recording formats or settings.")
def list_(
    what: Annotated[str, Argument(help="robots, scenes, formats or settings.")],
    name: Annotated[
        str | None, Argument(help="settings: a table or a setting, such as estimator or balance.dcm_gain.")
    ] = None,
    robot: Annotated[
        str | None, Option(help="settings: the robot whose numbers are told where a default is a share of its body.")
    ] = None,
    as_json: Json = False,
) -> None:
    """List what there is: robots to walk, scenes to run, recording formats to analyse, settings to change.

    Each setting is shown with its default, unit and range; `--set` and `--grid` take its dotted name. A default that
    grows with the robot is shown with its share: "70.02 N = 0.083 weight" for H1, or for `--robot`.

    Example: plantar list formats

    Example: plantar list settings estimator
    """
    for given, words in ((name, "name"), (robot, "robot")):
        if given is not None and what != "settings":
            raise InputError(f"'list {what}' takes no {words}, got '{given}'; allowed: plantar list settings NAME")
    if what == "settings":
        need_libraries("sim", "mujoco")
        from plantar.settings.setting_text import setting_rows, setting_text
        from plantar.sim.run.setting_list import settings_of_robot

        told = settings_of_robot(name, robot)
        end_command({what: setting_rows(told)}, as_json, setting_text(told))
        return
    from plantar.sim.run.listing import listed

    found = listed(what)
    width = max((len(name) for name in found), default=0)
    text = "\n".join(f"{name:{width}}  {text}".rstrip() for name, text in found.items())
    end_command({what: [{"name": name, "description": text} for name, text in found.items()]}, as_json, text)


@app.command(short_help="Measure run time against error, and show it on a page.")
def bench(
    what: Annotated[str, Argument(help="kernels, contact, scenes, skip, stress or all.")] = "all",
    layout: Annotated[
        Path | None, Option(help="contact: layout file of the sole. Default: 250 x 155 mm with taxels of 691 mm^2.")
    ] = None,
    scenarios: Annotated[int, Option(help="stress: how many scenarios.")] = 10_000,
    first: Annotated[int, Option(min=0, help="stress: number of the first one.")] = 0,
    scene: Annotated[
        list[str] | None, Option(metavar="SCENE", help="scenes: a walk to run (again for more). Default: all.")
    ] = None,
    robot: Annotated[
        list[str] | None, Option(metavar="ROBOT", help="scenes: a robot to run them with, likewise.")
    ] = None,
    quick: Annotated[bool, Option("--quick", help="scenes, all: what tells most, once.")] = False,
    output: Output = Path("out/bench"),
    as_json: Json = False,
) -> None:
    """Measure run time against error, and write tables, figures and bench.json.

    kernels: the perception's kernels beside scipy, shapely, cv2 and approximations, with the error against exact
    references; under 2 minutes.

    contact: ways to simulate a sole's contact and its taxels, against MuJoCo's exact contact wrench. Exit code 1 if the
    chosen model is not as right as it must be (centre of pressure within 2 mm, tip-over edge within 1 mm).

    scenes: short walks over the settings that trade run time against error (physics step, contact, solver, skin and
    control rate, taxel size), beside a fine reference of the same walk: half an hour; --quick 3 minutes. scene_runs.csv
    goes on where it was left.

    skip: short walks with what a scene needs and with everything, to the same last bit: what was skipped, the time it
    saves, the time by room, and everything but the physics over the physics alone; 5 minutes. Exit code 1 if a motion
    is not the same.

    stress: the whole loop in random short scenarios (noise, lost packets, jitter, dead and stuck taxels, silent
    sensors, saturation, edges, masses and gains anywhere in their ranges, 1 km from the origin, float32): exit code 1
    if one raises or commands nonsense. A second or two each; stress.csv goes on where it was left. Not part of all.

    all: kernels, contact, skip, quick scenes on flat ground and the papers' experiments, and bench.html, one page that
    shows them; about 12 minutes of one core, --quick 4.

    Example: plantar bench all -o out/bench

    Example: plantar bench kernels -o out/bench

    Example: plantar bench stress --scenarios 10 --json
    """
    from plantar.sim.bench.kinds import BenchOptions, measure

    walks = tuple(scene or ()), tuple(robot or ())
    told = measure(what, BenchOptions(layout, scenarios, first, *walks, quick), output)
    end_command(told.result, as_json, told.text, told.failures, bool(told.failures))


@app.command(short_help="Say what is installed, what is missing and how to get it.")
def doctor(as_json: Json = False) -> None:
    """Say what is installed of what Plantar can use, what is missing or broken, and how to get it.

    Exit code 1 if something that is always needed is missing, or something that is installed cannot be loaded.

    Example: plantar doctor
    """
    from plantar import doctor as examination

    found = examination.examine()
    failures = ["a library is missing or broken: see above"] if not found["holds"] else []
    end_command(found, as_json, examination.doctor_text(found), failures, not found["holds"])


def main() -> None:
    """Entry point of the console script."""
    sys.exit(run(lambda: run_command(app)))
