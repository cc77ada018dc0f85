"""`plantar demo`: the main job in one go."""

import json
from importlib.resources import as_file, files
from pathlib import Path
from typing import Annotated

from typer import Option

from plantar.common.console.command import Command, Json, end_command
from plantar.common.console.progress import part_of, progress_bar
from plantar.common.optional_library import need_libraries
from plantar.common.sides import SIDES
from plantar.kernels import need_compiled
from plantar.sim.libraries import LIBRARIES


def demo(
    output: Annotated[Path, Option("-o", "--output", help="Folder for everything that is made.")] = Path("out"),
    seed: Annotated[int, Option(help="Seed of the sensor noise.")] = 0,
    small: Annotated[
        bool, Option("--small", help="Only analyse and show two recordings that are installed: no MuJoCo, no CAD.")
    ] = False,
    as_json: Json = False,
) -> None:
    """The main job in one go: build the H1's tactile shoes, walk a 12 cm beam on their feedback, analyse the walk.

    The simulator wears the layouts just written, and the analysis reads the recording just made.

    Example: plantar demo -o out

    With --small in seconds: reports of a robot's walk and of a walk on insoles, and the robot's as a page in 3D.

    Example: plantar demo --small
    """
    if small:
        _small(output, as_json)
        return
    need_libraries("sim", *LIBRARIES)
    need_compiled("walking")
    from plantar.common.atomic import output_folder, write_text
    from plantar.common.pages.folder_page import with_folder_page
    from plantar.gait.analysis.analyse_one import analyse_recording
    from plantar.layouts.layout_file import read_layout
    from plantar.shoes import build_shoe, export_shoe
    from plantar.shoes.foot.source import foot_of_robot
    from plantar.sim.figures.run_figure import plot_run
    from plantar.sim.run.run_text import demo_text
    from plantar.sim.run.runner import run_scene
    from plantar.sim.run.scene import load_scene

    with output_folder(output) as folder, progress_bar() as progress:
        for name in ("shoe", "walk", "analysis"):
            (folder / name).mkdir()
        foot, taxels = foot_of_robot("h1")
        build = build_shoe(foot, taxels=taxels, progress=part_of(progress, 0.0, 0.3, "shoe: "))
        report = export_shoe(build, folder / "shoe", progress=part_of(progress, 0.3, 0.2, "shoe: ")).as_dict()
        layouts = {s: read_layout(folder / "shoe" / f"layout_{s}.json") for s in SIDES}
        recording = folder / "walk" / "run.mcap"
        part = part_of(progress, 0.5, 0.3, "walk: ")
        walk = run_scene(load_scene("beam"), seed, layouts=layouts, record=recording, progress=part)
        plot_run(recording, folder / "walk")
        write_text(folder / "walk" / "summary.json", json.dumps(walk, indent=1) + "\n")
        part = part_of(progress, 0.8, 0.2, "analysis: ")
        analysis = analyse_recording(recording, folder / "analysis", progress=part)
        files = sorted(str(output / p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    files = with_folder_page(output, "A shoe, a walk on it, and its analysis", files)
    done = bool(walk["completed"]) and bool(report["holds"])
    made = {"completed": done, "shoe": report, "walk": walk, "analysis": analysis, "files": files}
    end_command(made, as_json, demo_text(made, output), failed=not done)


def _small(output: Path, as_json: bool) -> None:
    """Analyse the two recordings that tools/small_demo.py made, and write the page of the robot's."""
    from plantar.common.atomic import output_folder
    from plantar.common.pages.folder_page import with_folder_page
    from plantar.gait.analysis.analyse_one import analyse_recording
    from plantar.viewer.page import write_page

    recordings = files("plantar.commands").joinpath("small_demo")
    analyses = {}
    with (
        output_folder(output) as folder,
        progress_bar() as progress,
        as_file(recordings.joinpath("robot.mcap")) as robot,
        as_file(recordings.joinpath("insole.asc")) as insole,
    ):
        for place, recording in enumerate((robot, insole)):
            part = part_of(progress, 0.5 * place, 0.4, f"{recording.stem}: ")
            analyses[recording.stem] = analyse_recording(recording, folder / recording.stem, progress=part)
        write_page([robot], folder / "robot" / "view.html")
        made = sorted(str(output / p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    made = with_folder_page(output, "A robot's walk, and one on insoles", made)
    pages = [output / "robot" / "report.html", output / "robot" / "view.html", output / "insole" / "report.html"]
    says = ["a robot's walk: its report, and the page that plays it in 3D; a walk on insoles: its report"]
    end_command({"analysis": analyses, "files": made}, as_json, "\n".join([*says, *(f"  {p}" for p in pages)]))


COMMAND = Command(demo, "The main job in one go: shoe, walk on a beam, analysis.", 70)
