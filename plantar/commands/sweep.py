"""`plantar sweep`: run a scene over settings and seeds, or search where it breaks."""

import os
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, Output, end_command
from plantar.common.console.ending import Terminated, ignore_further_interrupts, print_note
from plantar.common.console.progress import progress_bar
from plantar.common.optional_library import need_libraries
from plantar.kernels import need_compiled
from plantar.sim.libraries import LIBRARIES


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
        list[str] | None, Option(metavar="KEY=FROM:TO", help="Draw a setting from a range for each seed; repeatable.")
    ] = None,
    seeds: Annotated[
        int | None,
        Option(help="Seeds of each grid point; the most, with --limit. Default: 1, or 1000 with --limit."),
    ] = None,
    first_seed: Annotated[int, Option(help="The first of them; for seeds that were not used for tuning.")] = 0,
    robot: Annotated[str | None, Option(help="Robot to use instead of the scene's.")] = None,
    settings: Annotated[
        list[str] | None, Option("--set", metavar="KEY=VALUE", help="A setting of all runs; repeatable.")
    ] = None,
    workers: Annotated[int, Option(help="Processes on this machine. Default: one a core.", show_default=False)] = 0,
    scheduler: Annotated[str | None, Option(help="Address of a Dask scheduler, tls://host:8786.")] = None,
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
    need_compiled("a sweep")
    from plantar.common.workers.cluster_workers import network_note
    from plantar.sim.sweep import SweepStopped, plan_from_texts, run_sweep
    from plantar.sim.sweep.sweep_text import sweep_errors, sweep_text

    wanted = plan_from_texts(
        scene, grid or [], seeds, robot, settings or [], first_seed, limit=limit, within=within, random=random or []
    )
    if scheduler is not None and (note := network_note(scheduler)):
        print_note(f"note: {note}")
    try:
        with progress_bar() as progress, ignore_further_interrupts():
            count = workers or os.cpu_count() or 1
            result = run_sweep(wanted, output, workers=count, scheduler=scheduler, progress=progress)
    except SweepStopped as stop:
        raise Terminated(stop.number, str(stop)) from None
    failed = not all(found["reached"] for found in result.get("limits", ()))
    end_command(result, as_json, sweep_text(result, scene), () if as_json else sweep_errors(result, scene), failed)


COMMAND = Command(sweep, "Run a scene over settings and seeds, or search where it breaks.", 60)
