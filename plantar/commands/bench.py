"""`plantar bench`: measure run time against error, and write tables, figures and bench.json."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, Output, end_command


def bench(
    what: Annotated[str, Argument(help="kernels, scenes, skip, stress, footholds or all.")] = "",
    scenarios: Annotated[int, Option(help="stress: how many scenarios.")] = 10_000,
    first: Annotated[int, Option(min=0, help="stress: number of the first one.")] = 0,
    scene: Annotated[
        list[str] | None,
        Option(
            metavar="SCENE", help="scenes: a walk to run (again for more); footholds: a kind of trial. Default: all."
        ),
    ] = None,
    robot: Annotated[
        list[str] | None, Option(metavar="ROBOT", help="scenes, footholds: a robot to run them with, likewise.")
    ] = None,
    quick: Annotated[bool, Option("--quick", help="scenes, all: the most telling ones, once.")] = False,
    policy: Annotated[
        Path | None,
        Option(
            help="footholds: Python file with make_policy(task), or zero, net-force, ankles or plantar. Default: all."
        ),
    ] = None,
    seeds: Annotated[int, Option(min=1, help="footholds: runs of each trial.")] = 100,
    output: Output = Path("out/bench"),
    as_json: Json = False,
) -> None:
    """Measure run time against error, and write tables, figures and bench.json.

    kernels: perception next to scipy, shapely, cv2 and approximations, with errors against exact references; under 2
    minutes.

    scenes: short walks over the settings that trade run time against error (physics step, contact, solver, skin and
    control rate, taxel size), next to a fine reference of the same walk: half an hour; --quick 3 minutes.
    scene_runs.csv goes on where it was left.

    skip: short walks with what a scene needs and with everything: what was skipped, the time it saves, the time by
    room; 5 minutes. Exit code 1 if a motion is not the same to the last bit.

    stress: the whole loop in random short scenarios (noise, lost packets, faulty taxels, silent sensors, any allowed
    masses and gains): exit code 1 if one raises or commands what no robot can follow. A second or two each; stress.csv
    goes on where it was left. Not part of all.

    footholds: the action 0, the built-in controller by its soles' net force, by its ankles and by its taxels, or your
    own policy, on narrow and uneven ground, under pushes and at velocities; a second or two a run. footholds.csv goes
    on where it was left; another policy adds its rows.

    all: kernels and skip; about 8 minutes of one core, --quick 2.

    Example: plantar bench all -o out/bench

    Example: plantar bench kernels -o out/bench

    Example: plantar bench stress --scenarios 10 --json

    Example: plantar bench footholds --policy examples/own_policy.py --seeds 10
    """
    from plantar.bench.kind import BenchOptions
    from plantar.sim.bench.runner import run_bench

    walks = tuple(scene or ()), tuple(robot or ())
    done = run_bench(what, BenchOptions(scenarios, first, *walks, quick, policy, seeds), output)
    end_command(done.result, as_json, done.text, done.failures, bool(done.failures))


COMMAND = Command(bench, "Measure run time against error.", 90)
