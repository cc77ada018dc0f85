"""Pictures of a run; without a display set MUJOCO_GL=egl before MuJoCo's import."""

import os
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import replacing
from plantar.common.optional_library import optional_library
from plantar.errors import InputError

FRAME_RATE = 25.0
"""Frames a second of a video; a whole number of physics steps apart."""


@dataclass(frozen=True)
class Line:
    """A rod from `start` to `end` (3,) with `radius` in m and `colour` (red, green, blue, opacity)."""

    start: NDArray[np.float64]
    end: NDArray[np.float64]
    radius: float
    colour: tuple[float, float, float, float]


@dataclass(frozen=True)
class View:
    """A camera's position relative to a body; by default right front.

    Attributes:
        distance: Of the eye in m.
        azimuth: About z in degrees.
        elevation: Against the horizon in degrees.
        below: Picture middle below the body's origin in m.
    """

    distance: float = 2.6
    azimuth: float = 145.0
    elevation: float = -12.0
    below: float = 0.25


class Camera:
    """Shows a body of a simulation and follows it.

    Args:
        model: MuJoCo model.
        body: Body id.
        width: In pixels.
        height: In pixels.
        view: Its position.
        groups: Geom groups shown next to 0, 1 and 2.
        fast: Whether to skip smoothing and halve shadows.

    Raises:
        InputError: If no renderer can be made.
    """

    def __init__(
        self,
        model: Any,
        body: int,
        width: int = 960,
        height: int = 540,
        view: View | None = None,
        groups: Sequence[int] = (),
        fast: bool = False,
    ) -> None:
        import mujoco

        view = view or View()
        self._body = body
        self._camera = mujoco.MjvCamera()
        self._shown = mujoco.MjvOption()
        self._shown.geomgroup[list(groups)] = True
        self._camera.distance = view.distance
        self._below = view.below
        self._camera.azimuth = view.azimuth
        self._camera.elevation = view.elevation
        model.vis.global_.offwidth = max(model.vis.global_.offwidth, width)
        model.vis.global_.offheight = max(model.vis.global_.offheight, height)
        quality = model.vis.quality
        kept = quality.offsamples, quality.shadowsize
        if fast:
            quality.offsamples = 0
            quality.shadowsize = kept[1] // 2
        try:
            self._renderer = mujoco.Renderer(model, height, width)
        except Exception as error:  # MuJoCo raises what its OpenGL loader raises
            raise InputError(
                f"cannot render without a display ({error}); set MUJOCO_GL=egl before Python starts, and install "
                "the OpenGL library where it is missing: apt-get install libegl1 libgl1-mesa-dri"
            ) from None
        finally:
            quality.offsamples, quality.shadowsize = kept

    def picture(
        self,
        data: Any,
        lines: Sequence[Line] = (),
        dots: tuple[NDArray[np.float64], NDArray[np.float64], float] | None = None,
    ) -> NDArray[np.uint8]:
        """Returns the RGB picture (height, width, 3) of the state `data`, with `lines` and `dots`.

        Dots: places (n, 3) in m, colours (n, 3), half a side in m.
        """
        import mujoco

        self._camera.lookat[:] = data.xpos[self._body] - np.array([0.0, 0.0, self._below])
        self._renderer.update_scene(data, self._camera, self._shown)
        scene = self._renderer.scene
        kind = mujoco.mjtGeom.mjGEOM_CAPSULE
        for line in lines:
            geom = scene.geoms[scene.ngeom]
            rgba = np.array(line.colour, dtype=np.float32)
            mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.zeros(9), rgba)
            mujoco.mjv_connector(geom, kind, line.radius, line.start, line.end)
            scene.ngeom += 1
        if dots is not None:
            size = np.full(3, dots[2])
            turn = np.eye(3).ravel()
            for place, colour in zip(dots[0], np.column_stack([dots[1], np.ones(len(dots[1]))]), strict=True):
                geom = scene.geoms[scene.ngeom]
                mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_BOX, size, place, turn, colour.astype(np.float32))
                scene.ngeom += 1
        return np.asarray(self._renderer.render())

    def pixels(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Pixels (n, 2), x right and y down, of points (n, 3) in m in the last picture."""
        left, right = self._renderer.scene.camera
        forward = np.array(left.forward)
        up = np.array(left.up)
        offset = points - 0.5 * (np.array(left.pos) + np.array(right.pos))
        height = self._renderer.height
        width = self._renderer.width
        # What is as far as the near plane's distance fills half the picture at frustum_top.
        scale = 0.5 * height * left.frustum_near / left.frustum_top / (offset @ forward)
        return np.column_stack(
            [0.5 * width + scale * (offset @ np.cross(forward, up)), 0.5 * height - scale * (offset @ up)]
        )

    def close(self) -> None:
        """Free the renderer."""
        self._renderer.close()


def opencv() -> Any:
    """The module OpenCV; an InputError names how to get it."""
    with optional_library("cv2", "sim"):
        import cv2
    return cv2


def save_picture(picture: NDArray[np.uint8], path: str | os.PathLike[str]) -> Path:
    """Save an RGB `picture` (height, width, 3) at `path` as PNG or JPEG; returns the path."""
    cv2 = opencv()
    with replacing(path) as temporary:
        cv2.imwrite(str(temporary), picture[:, :, ::-1])
    return Path(path)


class VideoWriter(ExitStack):
    """Writes an MP4 at `path`, `rate` frames a second; a context manager."""

    def __init__(self, path: str | os.PathLike[str], rate: float = FRAME_RATE) -> None:
        super().__init__()
        if Path(path).suffix != ".mp4":
            raise InputError(f"video {path} needs a name that ends in .mp4")
        self._cv2 = opencv()
        self._rate = rate
        self._temporary = self.enter_context(replacing(path))
        self._writer: Any = None

    def add(self, picture: NDArray[np.uint8]) -> None:
        """Add an RGB frame (height, width, 3)."""
        if self._writer is None:
            height, width = picture.shape[:2]
            code = self._cv2.VideoWriter.fourcc(*"mp4v")
            self._writer = self._cv2.VideoWriter(str(self._temporary), code, self._rate, (width, height))
            self.callback(self._writer.release)  # before the file gets its name
            if not self._writer.isOpened():
                raise InputError("cannot encode MP4: this OpenCV has no video encoder")
        self._writer.write(picture[:, :, ::-1])
