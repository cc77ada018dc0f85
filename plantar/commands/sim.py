"""`plantar sim`: run one scenario in MuJoCo and judge it by the true contact forces."""

import os
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, Option

from plantar.common.console.command import Command, Json, end_command
from plantar.common.console.progress import progress_bar
from plantar.common.optional_library import need_libraries
from plantar.errors import InputError
from plantar.sim.libraries import LIBRARIES


def sim(
    scene: Annotated[
        str | None,
        Argument(
            metavar="SCENE", help="A built-in scene (plantar list scenes) or a scene .toml file.", show_default=False
        ),
    ] = None,
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
    video: Annotated[Path | None, Option(help="Write a video with what the soles measure: an .mp4 file.")] = None,
    plot: Annotated[Path | None, Option(help="Folder for figures: balance, plane and feet.")] = None,
    bring_up: Annotated[
        bool,
        Option("--bring-up", help="First check sensors and wiring, as on a robot; exit code 1 if not passed."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Run one scenario in MuJoCo and judge it by the true contact forces.

    The controller reads taxels, encoders and IMU only; the judge reads the simulator. Exit code 1 if the robot fell or
    did not do what was planned.

    Example: plantar sim flat --robot h1 --plot out/flat

    Example: plantar sim push --seed 3 --set feedback=false --json

    With --set plant=random the true robot, its sensors and the ground differ from what the controller takes them for,
    by the seed, as much as ordinary care leaves; level=1 halves that, level=3 has half more, 0 is the exact plant
    (plantar list settings plant).

    Example: plantar sim flat --set plant=random
    """
    if scene is None:
        from plantar.sim.run.listing import listed

        raise InputError(
            f"give a scene: plantar sim flat; allowed: {', '.join(listed('scenes'))}, or a scene .toml file"
        )
    if seed < 0:
        raise InputError(f"--seed is {seed}; allowed: 0 or more")
    if video is not None:
        os.environ.setdefault("MUJOCO_GL", "egl")
    need_libraries("sim", *LIBRARIES)
    from plantar.sim.run.run_text import run_text
    from plantar.sim.run.scene_kind import open_scene, run

    loaded = open_scene(scene, settings or [], robot)
    if bring_up:
        _run_with_bring_up(loaded, seed, (record, video, plot), as_json)
        return
    with progress_bar() as progress:
        summary = run(loaded, seed, record=record, video=video, plot=plot, progress=progress)
    end_command(summary, as_json, run_text(summary), failed=not summary["completed"])


def _run_with_bring_up(
    scene: Any, seed: int, files: tuple[Path | None, Path | None, Path | None], as_json: bool
) -> None:
    """Check the robot, and run the scene if it passed; `files` are recording, video and figures."""
    from plantar.sim.run.bring_up import bring_up_summary, bring_up_text, check_before_walk
    from plantar.sim.run.run_text import run_text
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene_kind import simulation_of

    begun = simulation_of(scene, seed)
    if not isinstance(begun, Simulation):
        raise InputError(f"--bring-up is for scenes of a walk; '{scene.name}' is an experiment of the companion")
    checks = check_before_walk(begun)
    if not checks.passed:
        refused = {"scene": scene.name, "robot": scene.robot, "seed": seed, "completed": False}
        end_command({**refused, "bring_up": bring_up_summary(checks)}, as_json, bring_up_text(checks), failed=True)
        return
    record, video, plot = files
    with progress_bar() as progress:
        summary = begun.run_to_files(record, video, plot, progress)
    summary["bring_up"] = bring_up_summary(checks)
    text = f"{bring_up_text(checks)}\n{run_text(summary)}"
    end_command(summary, as_json, text, failed=not summary["completed"])


COMMAND = Command(sim, "Run one scenario in MuJoCo, judged by the true contacts.", 40)
