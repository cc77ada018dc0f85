"""`plantar robot`: make a walking robot from its model, or check one."""

import os
from functools import partial
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, Output, end_command
from plantar.common.console.progress import part_of, progress_bar
from plantar.common.optional_library import need_libraries
from plantar.errors import InputError, RobotError
from plantar.kernels import need_compiled
from plantar.sim.libraries import LIBRARIES


def robot(
    model: Annotated[
        Path, Argument(metavar="MODEL", help="Robot's model (.xml .mjcf .urdf), or the word check.", show_default=False)
    ],
    robot_file: Annotated[Path | None, Argument(metavar="ROBOT.toml", help="After check: the robot file.")] = None,
    scene: Annotated[str | None, Option(help="check: the scene whose plan is looked at. Default: flat.")] = None,
    trials: Annotated[
        str, Option(help="Trial walks that decide: flat, stone, slab, push; flat alone takes a third of the time.")
    ] = "flat,stone,slab,push",
    height: Annotated[
        float | None, Option(min=0.05, max=5.0, help="Height of the CoM above the soles in m, instead of the best.")
    ] = None,
    stance: Annotated[
        float | None, Option(min=0.01, max=2.0, help="Distance of the ankles in m, instead of the model's.")
    ] = None,
    posture: Annotated[
        str | None,
        Option(help="Arms, head and waist: a keyframe's name, zero, or degrees as elbow=90,waist=0."),
    ] = None,
    imu: Annotated[str | None, Option(help="Site or body of the IMU, instead of the lowest one.")] = None,
    leg: Annotated[
        float | None,
        Option(min=0.05, max=5.0, help="Length in m that steps and clearance are shares of, for shorter ones."),
    ] = None,
    foot: Annotated[str | None, Option(help="Both bodies that wear shoes, as l_foot,r_foot.")] = None,
    solid: Annotated[bool, Option("--solid", help="Build the printable shoes, too; takes half a minute.")] = False,
    output: Output = Path("out/robot"),
    as_json: Json = False,
) -> None:
    """Make a robot that walks of its model: robot.toml, a copy of the model, layouts of its shoes and a picture.

    Finds legs (two chains of four hinges or more), soles, IMU and limits, and fits height, stance, pace and servo gains
    to them; an option states one instead. Each value in robot.toml describes how it was found. The robot then walks in
    simulation: level ground, a stone under 30 % of a sole, a slab that it does not know of, and pushed. Exit code 1 if
    one is not completed. Its file is written all the same, to be changed and tried again.

    With check, measures what would go wrong in a scene, and names which value works; exit code 1 if something would.

    Example: plantar robot my_robot.urdf -o out/mine && plantar sim flat --robot out/mine/robot.toml

    Example: plantar robot check out/mine/robot.toml --scene beam
    """
    os.environ.setdefault("MUJOCO_GL", "egl")
    need_libraries("sim", *LIBRARIES)
    if (str(model) == "check") != (robot_file is not None) or (robot_file is None and scene is not None):
        raise InputError("a robot file and --scene are for the check: plantar robot check ROBOT.toml --scene beam")
    if robot_file is None and model.suffix.lower() == ".toml":
        raise InputError(f"{model} is no model but a robot file; look at it with: plantar robot check {model}")
    stated = {"--height": height, "--stance": stance, "--posture": posture, "--imu": imu}
    stated |= {"--foot": foot, "--leg": leg}
    given = [option for option, value in stated.items() if value is not None]
    if robot_file is not None and given:
        raise InputError(f"{given[0]} is for a model, not for the check; in a robot file change what it stands for")
    if robot_file is not None:
        from plantar.sim.survey.check import check_robot

        checked = check_robot(robot_file, scene or "flat")
        end_command(checked.as_dict(), as_json, checked.text(), checked.failures, not checked.holds)
        return
    from plantar.robots.survey.wishes import Wishes, feet_named
    from plantar.sim.survey.trial_walk import trial_names

    names = trial_names(trials)
    wishes = Wishes(height, stance, posture, imu, None if foot is None else feet_named(foot), leg)
    need_compiled("walking")  # before a survey of minutes, whose robot could not be tried
    from plantar.common.atomic import output_folder
    from plantar.common.files.model_files import files_of_model
    from plantar.shoes.found_foot import shoe_for_surface
    from plantar.sim.survey.introduce import introduce

    with output_folder(output, files_of_model(model, RobotError)) as folder, progress_bar() as progress:
        fitted = partial(shoe_for_surface, solid=solid, progress=part_of(progress, 0.1, 0.5))
        made = introduce(model, folder, fitted, progress, wishes, names)
        _refuse_other(output, made.robot.description)
    why = () if made.walks else (*made.missed, *made.walked)
    end_command(made.as_dict(output), as_json, made.text(output), why, not made.walks)


def _refuse_other(output: Path, description: str) -> None:
    """Refuse a folder that holds another robot, whose files would mix with this one's."""
    from plantar.common.files.structured_text import read_toml

    file = output / "robot.toml"
    other = read_toml(file, RobotError, str(file)).get("description") if file.exists() else description
    if other != description:
        raise InputError(f"{output} holds another robot ({other}); choose another folder with -o")


COMMAND = Command(robot, "Make a robot of an MJCF or URDF, ready to walk, and check it.", 30)
