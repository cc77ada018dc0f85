"""Videos of a run: world, forces and taxels."""

import os
from collections.abc import Mapping
from contextlib import ExitStack
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.surface import OBSTACLE_GROUP
from plantar.sim.figures.drawn_run import scale_colours
from plantar.sim.figures.render import Camera, VideoWriter, View, opencv
from plantar.sim.figures.sole_inset import SoleInset
from plantar.sim.model.world import World

_INSET = 0.25  # of the picture's height
_ARROW = 0.5  # leg: length of the arrow for the robot's weight
_LEAST = 0.05  # weight on a sole below which none is drawn: a swing foot's noise
_COLOUR = (217, 26, 77)
_WIDTH = 960
_HEIGHT = 540
_TAXEL = 0.005  # m: half a side of the cube that is drawn for a taxel of a body
_FULL_TAXEL = 0.01  # weight on a taxel of a body that has the last colour
# patches whose force is written, and in which colour
_LINES = 4
_INK = (40, 40, 40)


class _Filmed(ExitStack):
    def __init__(self, path: str | os.PathLike[str], model: Any, body: int, **shown: Any) -> None:
        super().__init__()
        self._camera = Camera(model, body, _WIDTH, _HEIGHT, fast=True, **shown)
        self.callback(self._camera.close)
        self._writer = self.enter_context(VideoWriter(path))


class Film(_Filmed):
    """A video at `path` (MP4) that follows a robot's torso in a `world`."""

    def __init__(self, path: str | os.PathLike[str], world: World) -> None:
        super().__init__(path, world.model, world.torso)
        self._world = world
        self._inset = SoleInset(world.robot.layouts, world.body.weight, round(_INSET * _HEIGHT))

    def add(self, readings: Mapping[Side, Reading]) -> None:
        """Add a frame with the soles' readings or None."""
        picture = np.array(self._camera.picture(self._world.data))
        if set(readings) == set(self._world.robot.layouts):
            self._draw_forces(picture, readings)
            self._inset.draw(picture, readings, float(self._world.data.time))
        self._writer.add(picture)

    def _draw_forces(self, picture: NDArray[np.uint8], readings: Mapping[Side, Reading]) -> None:
        world = self._world
        cv2 = opencv()
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


class BodyFilm(_Filmed):
    """A video at `path` (MP4) of a machine with `skin`: taxels and patch forces.

    The camera follows a `body` of `model` and `data` from a `view`.
    """

    def __init__(
        self, path: str | os.PathLike[str], model: Any, data: Any, skin: FoamSkins, body: str, view: View
    ) -> None:
        super().__init__(path, model, model.body(body).id, view=view, groups=[OBSTACLE_GROUP])
        self._data = data
        self._skin = skin
        self._weight = float(
            np.abs(model.opt.gravity[2]) * model.body_subtreemass[model.body_rootid[model.body(body).id]]
        )
        patches = skin.body_skin.patches
        self._bodies = np.concatenate([np.full(len(p.positions), model.body(p.link).id) for p in patches])
        self._places = np.concatenate([p.positions for p in patches])
        self._colours = scale_colours(1.0)

    def add(self) -> None:
        """Add a frame of the world now."""
        data = self._data
        force = self._skin.force
        points = data.xpos[self._bodies] + np.einsum(
            "ijk,ik->ij", data.xmat[self._bodies].reshape(-1, 3, 3), self._places
        )
        steps = np.minimum(force / (_FULL_TAXEL * self._weight), 1.0) * (len(self._colours) - 1)
        colours = np.where((force > 0.0)[:, None], self._colours[steps.astype(int)], 0.45)
        picture = np.array(self._camera.picture(data, dots=(points, colours, _TAXEL)))
        self._write_loads(picture)
        self._writer.add(picture)

    def _write_loads(self, picture: NDArray[np.uint8]) -> None:
        cv2 = opencv()
        skin = self._skin.body_skin
        loads = {p.name: float(self._skin.force[skin.slices[p.name]].sum()) / self._weight for p in skin.patches}
        most = sorted(loads.items(), key=lambda load: -load[1])[:_LINES]
        lines = [
            f"{self._data.time:.1f} s",
            *(f"{name.replace('_', ' ')}: {v:.3f} weights" for name, v in most if v > 0),
        ]
        for i, line in enumerate(lines):
            cv2.putText(picture, line, (16, 30 + 24 * i), cv2.FONT_HERSHEY_SIMPLEX, 0.6, _INK, 1, cv2.LINE_AA)
