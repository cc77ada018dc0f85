"""A small recording with all that a viewer shows, made without a simulator."""

from functools import cache
from pathlib import Path

import numpy as np

from plantar import grid_layout
from plantar.layouts.layout import SoleLayout, mirrored
from plantar.mechanics.rotation import level_rotation
from plantar.recordings.foxglove import (
    Template,
    cube,
    cylinder,
    delete_all,
    entity,
    frame_transform,
    line_loop,
    log_message,
    pose,
    sphere,
    triangles,
)
from plantar.recordings.recorder import Recorder

RED = (0.8, 0.1, 0.1, 1.0)
WEIGHT = 400.0
SECONDS = 2.0


@cache
def soles() -> dict[str, SoleLayout]:
    """Two soles of 4 by 2 cells."""
    left = grid_layout([[-0.1, -0.04], [0.1, -0.04], [0.1, 0.04], [-0.1, 0.04]], pitch=(0.05, 0.04))
    return {"left": left, "right": mirrored(left)}


def forces(time: float) -> dict[str, np.ndarray]:
    """Force in N on each taxel: the weight goes from the left sole to the right one, and from heel to toe."""
    share, out = time / SECONDS, {}
    for side, load in (("left", 1.0 - share), ("right", share)):
        x = soles()[side].positions[:, 0]
        falls = np.exp(-(((x - 0.2 * (share - 0.5)) / 0.05) ** 2))
        out[side] = WEIGHT * load * falls / falls.sum()
    return out


def turned(yaw: float) -> tuple[float, ...]:
    """Quaternion (x, y, z, w) of a turn about z."""
    return (0.0, 0.0, float(np.sin(yaw / 2)), float(np.cos(yaw / 2)))


def write_walk(path: Path, *, drawn: bool = True, mass: float | None = WEIGHT / 9.81, name: str = "test") -> Path:
    """Write it: a trunk that moves forward by 0.5 m over two soles that turn."""
    told = {"scene": name, "robot": "box", "seed": 4} | ({} if mass is None else {"mass_kg": mass})
    wedge = [(0.0, 0.0, 0.5), (0.1, 0.0, 0.5), (0.0, 0.1, 0.5), (0.0, 0.0, 0.6)]
    body = (
        cube(pose((0.0, 0.0, 0.2)), (0.2, 0.3, 0.4), RED),
        cylinder(pose((0.0, 0.0, -0.3)), (0.1, 0.1, 0.6), (0.3, 0.3, 0.3, 1.0)),
        triangles(wedge, [[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]], RED),
    )
    floor = cube(pose((0.0, 0.0, -0.001)), (20.0, 20.0, 0.002), (0.8, 0.8, 0.8, 1.0))
    with Recorder(path, told, soles()) as recorder:
        skin = {side: recorder.channel(f"/skin/{side}", [("force", 8)]) for side in ("left", "right")}
        truth = {s: recorder.channel(f"/truth/{s}", [("position", 3), ("rotation", 9)]) for s in ("left", "right")}
        if drawn:
            tf = recorder.message_channel("/tf", "foxglove.FrameTransforms")
            world, balance, steps = (
                recorder.message_channel(f"/scene/{n}", "foxglove.SceneUpdate")
                for n in ("world", "balance", "footsteps")
            )
            log = recorder.message_channel("/log", "foxglove.Log")
            world.write(0.0, Template(entity("world", "world", floor), entity("trunk", "trunk", *body)).filled(0.0))
            log.write(0.5, log_message(0.5, "step 1: foothold found <b>&", name="plan"))
            log.write(1.5, log_message(1.5, "the robot fell", "error"))
        for i in range(round(SECONDS * 50) + 1):
            time = i / 50
            x, yaw = 0.25 * time, 0.2 * time
            places = {"left": (x, 0.1, 0.0), "right": (x, -0.1, 0.0)}
            for side, force in forces(time).items():
                skin[side].write(time, force)
                truth[side].write(time, np.concatenate([places[side], level_rotation(yaw).ravel()]))
            if not drawn:
                continue
            frames = {f"sole_{side}": place for side, place in places.items()}
            frames |= {"trunk": (x, 0.0, 0.8), "center_of_mass": (x, 0.0, 0.9)}
            parts = [frame_transform(n, p, turned(yaw)) for n, p in frames.items()]
            tf.write(time, Template(*parts).filled(time))
            corners = [(x + 0.1 * np.cos(a), 0.1 * np.sin(a), 0.0) for a in np.linspace(0, 2 * np.pi, 13)[:-1]]
            ring = line_loop([tuple(map(float, c)) for c in corners], 0.01, (0.0, 1.0, 0.0, float(i < 50)))
            ball = sphere(pose((x, 0.02, 0.0)), (0.02,) * 3, (1.0, 0.0, 0.0, float(i < 50)))
            scene = entity("ZMP", "world", ball), entity("support polygon", "world", ring)
            balance.write(time, Template(*scene).filled(time))
            if i % 50 == 0:
                step = line_loop([(x, 0.0, 0.0), (x + 0.2, 0.0, 0.0), (x + 0.2, 0.1, 0.0)], 0.01, RED)
                update = delete_all(), entity(f"footstep {i // 50}", "world", step)
                steps.write(time, Template(*update).filled(time))
    return path
