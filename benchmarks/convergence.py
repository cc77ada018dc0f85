"""How forces and impacts depend on one setting of the physics at a time: `python benchmarks/convergence.py`."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

import mujoco
import numpy as np
from resumable import write_table

from plantar.bench.tables import markdown_table
from plantar.sim.model.world import _set_solver
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SCENE, STEPS = "uneven", 100
HEAD = ("setting", "robot", "impact, mean [N]", "90 % [N]", "against the first row", "force's ripple [% of weight]")
HEAD += ("ZMP at an edge [%]", "wall time over the first row's")

Change = Callable[[Any], None]


def option(name: str, value: Any, iterations: int = 20) -> Change:
    """Set an option of the physics before the world is compiled: readers of contacts depend on the cone."""

    def change(spec: Any) -> None:
        setattr(spec.option, name, value)
        spec.option.iterations = iterations

    return change


FIRST = "as it is: 1 ms, implicitfast, elliptic, Newton, 5 ms"
SOFTER = {"contacts half as soft, at 0.5 ms": 0.5, "contacts a quarter as soft, at 0.25 ms": 0.25}
CASES: dict[str, tuple[str, Change]] = {
    FIRST: ("0.001", lambda spec: None),
    "time step 0.5 ms": ("0.0005", lambda spec: None),
    "time step 0.25 ms": ("0.00025", lambda spec: None),
    "integrator Euler": ("0.001", option("integrator", mujoco.mjtIntegrator.mjINT_EULER)),
    "integrator implicit": ("0.001", option("integrator", mujoco.mjtIntegrator.mjINT_IMPLICIT)),
    "cone pyramidal": ("0.001", option("cone", mujoco.mjtCone.mjCONE_PYRAMIDAL)),
    "solver CG, 100 iterations": ("0.001", option("solver", mujoco.mjtSolver.mjSOL_CG, 100)),
    "solver PGS, 100 iterations": ("0.001", option("solver", mujoco.mjtSolver.mjSOL_PGS, 100)),
    "contacts half as soft, at 0.5 ms": ("0.0005", lambda spec: None),
    "contacts a quarter as soft, at 0.25 ms": ("0.00025", lambda spec: None),
}


def walk(robot: str, name: str) -> dict[str, Any]:
    period, change = CASES[name]
    scene = load_scene(SCENE, [f"steps={STEPS}", f"control.physics_period={period}"], robot=robot)

    def set_solver(spec: Any, period: float) -> None:
        _set_solver(spec, period)
        change(spec)

    with patch("plantar.sim.model.world._set_solver", set_solver):
        simulation = Simulation(scene, 0)
    simulation.world.model.geom_solref[:, 0] *= SOFTER.get(name, 1.0)
    return simulation.run()


if __name__ == "__main__":
    lines = []
    for robot in sys.argv[1:] or ("h1", "hrp2kai"):
        first: tuple[float, float, float] | None = None
        for name in CASES:
            found = walk(robot, name)
            impacts = np.array(found["impacts_N"])
            mean, most = float(impacts.mean()), float(np.percentile(impacts, 90))
            first = first or (mean, most, found["wall_time_s"])
            against = f"{100 * (mean / first[0] - 1):+.0f} %, {100 * (most / first[1] - 1):+.0f} %"
            rest = f"{100 * found['stance_force_rms']:.2f}", f"{100 * found['zmp_edge_share']:.2f}"
            time = found["wall_time_s"] / first[2]
            lines.append((name, robot, f"{mean:.1f}", f"{most:.1f}", against, *rest, f"{time:.1f}"))
            print(*lines[-1], len(impacts), "landings", flush=True)
    write_table(Path(__file__).with_name("convergence.md"), [markdown_table(HEAD, lines)])
