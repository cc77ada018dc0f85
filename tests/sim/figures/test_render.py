"""Rendering runs in a process of its own: MUJOCO_GL must be set before MuJoCo is imported."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import sys
from sim.figures.render import Camera, Film, save_picture
from sim.robots import load_robot
from sim.terrain import Ground
from sim.model.world import build_world
import mujoco
world = build_world(load_robot("h1"), Ground((), 0.0, 0.8))
mujoco.mj_forward(world.model, world.data)
camera = Camera(world.model, world.torso, 320, 180)
picture = camera.picture(world.data)
assert picture.shape == (180, 320, 3)
assert picture.std() > 10, "the picture is empty"
save_picture(picture, sys.argv[1] + "/picture.png")
with Film(sys.argv[1] + "/film.mp4", world) as film:
    for _ in range(3):
        film.add()
model = mujoco.MjModel.from_xml_string(
    "<mujoco><worldbody><light pos='0 0 3'/><geom type='box' size='1 1 1' group='3'/></worldbody></mujoco>"
)
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
seen, unseen = (Camera(model, 0, 320, 180, groups=g).picture(data).max() for g in ((3,), ()))
assert seen > unseen == 0, "geoms of another group are shown where that is asked for"
import cv2
assert cv2.VideoCapture(sys.argv[1] + "/film.mp4").get(cv2.CAP_PROP_FRAME_COUNT) == 3
"""


def test_pictures_and_videos(tmp_path: Path, repository: Path) -> None:
    environment = os.environ | {"MUJOCO_GL": "egl", "PYTHONPATH": str(repository)}
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path)], env=environment, capture_output=True, text=True, timeout=300
    )
    if run.returncode and "apt-get install libegl1" in run.stderr:
        pytest.skip("no OpenGL library for rendering without a display")
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "picture.png").stat().st_size > 1000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["film.mp4", "picture.png"]
