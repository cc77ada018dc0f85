"""What reading skins costs beside MuJoCo's step of the same model.

    python benchmarks/skin_cost.py g1.xml:left_ankle_roll_link,right_ankle_roll_link h1.xml:all ...

Each argument is a model and the bodies that wear a skin: named ones wear a sole, and the robot stands with its lowest
shape 0.2 mm in a floor; `all` are up to ten bodies with a patch round them, in the reference pose, and `all=distal`
those whose name has that. Steps begin at the same state each time. Times are the least of 200 alternating rounds, in
us of wall time.
"""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.bench.tables import markdown_table
from plantar.errors import PlantarError
from plantar.mujoco import Skin, Skins

STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
PAGE = """# What skins cost beside a step

Made by `python benchmarks/skin_cost.py`; its `--help` has how. One call of `plantar.mujoco.Skins` reads all skins.

"""


def least(calls: list[Callable[[], Any]], rounds: int = 200, each: int = 50) -> list[float]:
    """Least time of each call in us, of alternating rounds."""
    found = [np.inf] * len(calls)
    for _ in range(rounds):
        for i, call in enumerate(calls):
            began = time.perf_counter()
            for _ in range(each):
                call()
            found[i] = min(found[i], 1e6 * (time.perf_counter() - began) / each)
    return found


def on_floor(path: str) -> tuple[Any, Any]:
    """The model of a file on a floor, and its data in the reference pose."""
    spec = mujoco.MjSpec.from_file(path)
    spec.worldbody.add_geom(name="bench floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5.0, 5.0, 1.0])
    model = spec.compile()
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def stand(model: Any, data: Any) -> None:
    """Let the lowest shape lie 0.2 mm in the floor."""
    floor = model.geom("bench floor").id
    able = [g for g in range(model.ngeom) if g != floor and model.geom_contype[g] | model.geom_conaffinity[g]]
    gap = min(mujoco.mj_geomDistance(model, data, g, floor, 5.0, None) for g in able)
    data.qpos[2] -= gap + 2e-4
    mujoco.mj_forward(model, data)


def worn(model: Any, bodies: str) -> list[Any]:
    """The skins of an argument."""
    if not bodies.startswith("all"):
        return [Skin(body=name).bind(model) for name in bodies.split(",")]
    part = bodies.partition("=")[2]
    found: list[Any] = []
    for body in range(1, model.nbody):
        if model.body_weldid[body] and len(found) < 10 and part in model.body(body).name:
            try:
                found.append(Skin(body=model.body(body).name, around=(0, 0, 1)).bind(model))
            except PlantarError:
                continue
    return found


def row(path: str, bodies: str) -> list[str]:
    model, data = on_floor(path)
    skins = Skins(worn(model, bodies))
    if not bodies.startswith("all"):
        stand(model, data)
    start = np.empty(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, data, start, STATE)
    moving = mujoco.MjData(model)

    def step() -> None:
        mujoco.mj_setState(model, moving, start, STATE)
        mujoco.mj_step(model, moving)

    def apart() -> None:
        for skin in skins:
            skin(data)

    stepped, together, singly = least([step, lambda: skins(data), apart])
    touched = sum(bool(reading.wrench.any()) for reading in skins(data))
    taxels = sum(len(skin) for skin in skins)
    name = f"{Path(path).parent.name}/{Path(path).stem}"
    return [
        name, str(len(skins)), str(touched), str(taxels), f"{stepped:.1f}", f"{together:.1f}",
        f"{together / len(skins):.2f}", f"{singly:.1f}", f"{together / stepped:.2f}",
    ]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+", help="FILE:BODY,BODY or FILE:all")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    rows = [row(*given.rsplit(":", 1)) for given in options.models]
    head = ["model", "skins", "touched", "taxels", "step us", "all skins us", "each us", "one by one us", "of a step"]
    options.output.write_text(PAGE + markdown_table(head, rows))
    print(options.output.read_text())


if __name__ == "__main__":
    main()
