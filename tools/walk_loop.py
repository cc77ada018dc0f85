"""Make the front page's looping picture: a beam walked on the feedback of two soles.

MUJOCO_GL=egl python tools/walk_loop.py docs/images/beam.webp

Four side steps on the beam (scene beam, h1): two cycles of the walk. The camera follows, so the end goes over into the
beginning but for the way that was walked.
"""

import os
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

import cv2
from PIL import Image

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

SEED, STEPS = 3, 16
BEGIN, CYCLE = 14.6, 4.8  # s: both feet are on the beam by then; four steps
CROP = 720  # pixels of a frame's 960, from the left: the robot walks in the middle
EVERY, WIDTH = 2, 640  # frames of the video's 25 a second, and pixels


def main(path: str) -> None:
    """Walk, film, and keep one cycle.

    Args:
        path: File to write; its suffix names which format (.webp, .gif, .png).
    """
    with tempfile.TemporaryDirectory() as folder:
        video = Path(folder) / "walk.mp4"
        run_scene(load_scene("beam", [f"steps={STEPS}"]), SEED, video=video)
        film = cv2.VideoCapture(str(video))
        rate = film.get(cv2.CAP_PROP_FPS)
        pictures = []
        for number in range(round((BEGIN + CYCLE) * rate)):
            seen, frame = film.read()
            if not seen:
                break
            if number >= BEGIN * rate and number % EVERY == 0:
                height = round(WIDTH * frame.shape[0] / CROP)
                small = cv2.resize(frame[:, :CROP], (WIDTH, height), interpolation=cv2.INTER_AREA)
                pictures.append(Image.fromarray(cv2.cvtColor(small, cv2.COLOR_BGR2RGB)))
    first, *others = pictures
    options = {"quality": 55, "method": 4} if path.endswith(".webp") else {}
    first.save(path, save_all=True, append_images=others, duration=round(1000 * EVERY / rate), loop=0, **options)


if __name__ == "__main__":
    main(*sys.argv[1:])
