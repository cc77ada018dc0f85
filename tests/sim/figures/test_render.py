"""Rendering runs in a process of its own: MUJOCO_GL must be set before MuJoCo is imported."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import sys
import cv2
import numpy as np
from plantar.sensing.reading import Reading
from plantar.sim.figures.film import Film
from plantar.sim.figures.render import Camera, save_picture
from plantar.robots import load_robot
from plantar.sim.terrain import Ground
from plantar.sim.model.world import build_world
import mujoco
world = build_world(load_robot("h1"), Ground((), 0.0, 0.8))
mujoco.mj_forward(world.model, world.data)
camera = Camera(world.model, world.torso, 320, 180)
picture = camera.picture(world.data)
assert picture.shape == (180, 320, 3)
assert picture.std() > 10, "the picture is empty"
save_picture(picture, sys.argv[1] + "/picture.png")
ball = mujoco.MjModel.from_xml_string(
    "<mujoco><worldbody><light pos='0 0 3'/><body pos='0 0 1'><geom size='.3' rgba='0 0 0 0'/>"
    "<geom pos='.4 .3 .2' size='.03' rgba='1 1 1 1'/></body></worldbody></mujoco>"
)
data = mujoco.MjData(ball)
mujoco.mj_forward(ball, data)
other = Camera(ball, 1, 320, 180)
seen = np.argwhere(other.picture(data).max(axis=2) > 20).mean(axis=0)[::-1]
assert np.abs(other.pixels(data.geom_xpos[1:]) - seen).max() < 1.5, "a ball is seen where its pixel is said to be"
with Film(sys.argv[1] + "/film.mp4", world) as film:
    film.add({})
    for force in (0.0, 20.0):
        film.add({side: Reading(0.0, np.full(42, force)) for side in ("left", "right")})
model = mujoco.MjModel.from_xml_string(
    "<mujoco><worldbody><light pos='0 0 3'/><geom type='box' size='1 1 1' group='3'/></worldbody></mujoco>"
)
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
seen, unseen = (Camera(model, 0, 320, 180, groups=g).picture(data).max() for g in ((3,), ()))
assert seen > unseen == 0, "geoms of another group are shown where that is asked for"
video = cv2.VideoCapture(sys.argv[1] + "/film.mp4")
bare, unloaded, loaded = (video.read()[1].astype(int) for _ in range(3))
assert not video.read()[0]
below = np.s_[140:]  # where the inset is not: the same robot, and the lines of the forces on its soles
assert np.abs(bare[below] - unloaded[below]).max() < 40 < np.abs(unloaded[below] - loaded[below]).max()
assert np.abs(bare[:130, :200] - unloaded[:130, :200]).mean() > 20
"""


def test_pictures_and_videos(tmp_path, repository):
    environment = os.environ | {"MUJOCO_GL": "egl", "PYTHONPATH": str(repository)}
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path)], env=environment, capture_output=True, text=True, timeout=600
    )
    if run.returncode and "apt-get install libegl1" in run.stderr:
        pytest.skip("no OpenGL library for rendering without a display")
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "picture.png").stat().st_size > 1000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["film.mp4", "picture.png"]
