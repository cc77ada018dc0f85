"""Draw the README's picture: the robot in mid step, the forces on its taxels, and the walk in the plane.

MUJOCO_GL=egl python examples/walk_picture.py docs/images/walk.png
MUJOCO_GL=egl python examples/walk_picture.py docs/images/beam.png beam
"""

import os
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

import numpy as np

from plantar import Percept, Reading
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.recordings.recording import read_mcap
from plantar.sim.figures.render import Camera, View
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SCENES = {  # settings, seed, moment in s at which both feet are loaded, viewing direction
    "flat": (["steps=8"], 0, 6.88, 140.0),
    "beam": ([], 3, 30.36, 150.0),
}


def main(path: str, scene: str = "flat") -> None:
    """Walk, stop the clock at one moment, and draw."""
    settings, seed, moment, azimuth = SCENES[scene]
    simulation = Simulation(load_scene(scene, settings), seed=seed)
    camera = Camera(simulation.world.model, simulation.world.torso, 800, 1000, View(distance=2.9, azimuth=azimuth))
    pictures = []
    update = simulation.judge.update

    def update_and_picture(*arguments):  # the judge is called at every control tick
        if not pictures and simulation.world.data.time >= moment:
            pictures.append(camera.picture(simulation.world.data).copy())
        return update(*arguments)

    simulation.judge.update = update_and_picture
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "run.mcap"
        simulation.run(record=recording)
        run = read_mcap(recording)

    figure, axes = new_figure(13.0, 3.6, 1, 3, width_ratios=[0.85, 1.05, 2.9])
    axes[0].imshow(pictures[0])
    axes[0].axis("off")
    for side in ("left", "right"):
        layout, skin = run.layouts[side], run.topics[f"/skin/{side}"]
        force = skin.fields["force"][np.searchsorted(skin.time, moment)]
        percept = Percept(layout, Reading(moment, force))
        shift = np.array([0.0, 0.1 if side == "left" else -0.1])
        for i in range(len(layout)):
            ring = layout.cell_polygon(i) + shift
            shade = min(1.0, max(0.0, float(force[i]) / 40.0))
            axes[1].fill(
                -ring[:, 1], ring[:, 0], color=(1.0, 1.0 - 0.55 * shade, 1.0 - 0.85 * shade), ec="#adb5bd", lw=0.5
            )
        for ring, style in ((layout.outline, "-"), (percept.support_polygon_in_sole, "--")):
            if len(ring):
                closed = np.vstack([ring, ring[:1]]) + shift
                axes[1].plot(-closed[:, 1], closed[:, 0], style, color=COLOURS[side], lw=1.3)
        cop = percept.position_cop_in_sole
        if cop is not None:
            axes[1].plot(-(cop + shift)[1], (cop + shift)[0], "o", color=COLOURS["truth"], ms=5)
    axes[1].set_aspect("equal")
    axes[1].set_title("taxel forces of both soles,\nsupport polygon (dashed), CoP (dot)", fontsize=9)
    axes[1].set_xticks([])
    axes[1].set_ylabel("x in sole [m]")

    plane = axes[2]
    com = run.topics["/truth/body"].fields["com"][:, :2]
    turn = [0, 1] if np.ptp(com[:, 0]) > np.ptp(com[:, 1]) else [1, 0]  # a walk along y is drawn lying down
    for ring in run.metadata["ground"]:
        plane.fill(*np.array(ring)[:, turn].T, fc="#f1ece2", ec="#c9bfa8", lw=0.8)
    for side in ("left", "right"):
        truth = run.topics[f"/truth/{side}"]
        loaded = (truth.fields["normal_force"][:, 0] > 300.0).astype(int)
        for n, i in enumerate(np.flatnonzero(np.diff(np.concatenate([[0], loaded])) == 1)):
            rotation = truth.fields["rotation"][i].reshape(3, 3)
            ring = run.layouts[side].outline @ rotation[:2, :2].T + truth.fields["position"][i, :2]
            ring = np.vstack([ring, ring[:1]])
            plane.plot(*ring[:, turn].T, color=COLOURS[side], lw=0.9, label=f"{side} foothold" if n == 0 else None)
    plane.plot(*run.topics["/truth/body"].fields["zmp"][:, turn].T, color=COLOURS["truth"], lw=0.7, label="ZMP (true)")
    plane.plot(
        *run.topics["/estimate"].fields["dcm"][:, turn].T, color=COLOURS["active"], lw=1.2, label="DCM (estimated)"
    )
    plane.plot(*com[:, turn].T, color=COLOURS["polygon"], lw=1.6, label="CoM (true)")
    if "/foothold" in run.topics:
        found = run.topics["/foothold"]
        for n, row in enumerate(found.fields["polygon"]):
            ring = row.reshape(-1, 2)[np.isfinite(row.reshape(-1, 2)).all(axis=1)]
            plane.fill(*ring[:, turn].T, color=COLOURS["edge"], alpha=0.04, lw=0.0)
            if n == 0:
                plane.fill([], [], color=COLOURS["edge"], alpha=0.4, label="support found")
    around = np.array([0.25, 0.15])
    low, high = com[:, turn].min(axis=0) - around, com[:, turn].max(axis=0) + around
    plane.set_xlim(low[0], high[0])
    plane.set_ylim(*((low[1], high[1]) if turn == [0, 1] else (high[1], low[1])))
    plane.set_aspect("equal")
    plane.set_xlabel(f"{'xy'[turn[0]]} [m]")
    plane.set_ylabel(f"{'xy'[turn[1]]} [m]")
    plane.set_title("the walk in the plane", fontsize=9)
    plane.legend(fontsize=7, ncol=6, loc="upper center", bbox_to_anchor=(0.5, -0.32), frameon=False)
    save_figure(figure, path)


if __name__ == "__main__":
    main(*(sys.argv[1:3] or ["walk.png"]))
