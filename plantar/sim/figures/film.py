"""The video of a run: the world, the forces on its soles, and their taxels."""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.reading import Reading
from plantar.sides import Side
from plantar.sim.figures.render import Camera, VideoWriter, opencv
from plantar.sim.figures.sole_inset import SoleInset
from plantar.sim.model.world import World

__all__ = ["Film"]

_INSET = 0.25  # of the picture's height
_ARROW = 0.5  # leg: length of an arrow that stands for the robot's weight
_LEAST = 0.05  # weight on a sole below which none is drawn: a swing foot's noise
_COLOUR = (217, 26, 77)


class Film:
    """A video of a world; a context manager.

    Args:
        path: MP4 file to write.
        world: The world, followed at its torso.
    """

    def __init__(self, path: str | os.PathLike[str], world: World) -> None:
        self._world = world
        self._writer = VideoWriter(path)
        width, height = 960, 540
        self._camera = Camera(world.model, world.torso, width, height, fast=True)
        self._inset = SoleInset(world.robot.layouts, world.body.weight, round(_INSET * height))

    def __enter__(self) -> Self:
        self._writer.__enter__()
        return self

    def add(self, readings: Mapping[Side, Reading]) -> None:
        """Add a frame of the world as it is now.

        Args:
            readings: Readings of the soles; a sole that is missing is not drawn.
        """
        layouts = self._world.robot.layouts
        if set(readings) != set(layouts):
            self._writer.add(self._camera.picture(self._world.data))
            return
        picture = np.array(self._camera.picture(self._world.data))
        self._draw_forces(picture, readings)
        self._inset.draw(picture, readings, float(self._world.data.time))
        self._writer.add(picture)

    def _draw_forces(self, picture: NDArray[np.uint8], readings: Mapping[Side, Reading]) -> None:
        """The force on each sole as an arrow from its CoP upwards, over the legs that would hide it."""
        world, cv2 = self._world, opencv()
        for side, reading in readings.items():
            force = np.nan_to_num(reading.force)
            total = float(force.sum())
            if total < _LEAST * world.body.weight:
                continue
            site = world.sole_sites[side]
            turn = world.data.site_xmat[site].reshape(3, 3)
            start = world.data.site_xpos[site] + turn @ (force @ world.robot.layouts[side].positions / total)
            length = _ARROW * world.body.leg * total / world.body.weight
            ends = self._camera.pixels(np.array([start, start + length * turn[:, 2]])).round().astype(int)
            tip = 12.0 / max(12.0, float(np.hypot(*(ends[1] - ends[0]))))  # 12 pixels, regardless of the force
            cv2.arrowedLine(picture, *map(tuple, ends.tolist()), _COLOUR, 3, cv2.LINE_AA, tipLength=tip)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._writer.__exit__(kind, error, trace)
        self._camera.close()
