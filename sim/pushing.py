"""Pushes on the base, as a scene asks for them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gait.phases import WalkSchedule
from plantar.errors import SceneError
from sim.scene import Push
from sim.world import World

__all__ = ["Pusher"]

_DIRECTIONS = {
    "forward": (1.0, 0.0, 0.0),
    "backward": (-1.0, 0.0, 0.0),
    "left": (0.0, 1.0, 0.0),
    "right": (0.0, -1.0, 0.0),
}


class Pusher:
    """Applies a push to the torso body.

    Args:
        push: The push of the scene.
        schedule: Phases of the walk, which give the time of the push.
        seed: Chooses direction and step where the scene leaves them open: seeds 0-3 push forward, backward, left and
            right, seeds 4-7 again, and so on; the step is drawn.

    Raises:
        SceneError: If the scene pushes at a step that the walk does not have.
    """

    def __init__(self, push: Push, schedule: WalkSchedule, seed: int) -> None:
        self.direction = push.direction
        if self.direction == "seeded":
            self.direction = tuple(_DIRECTIONS)[seed % len(_DIRECTIONS)]
        self.step: int | None = None
        self.start = self.end = float("inf")
        self._force: NDArray[np.float64] = np.zeros(3)
        if push.impulse <= 0.0:
            return
        swings = [p for p in schedule.phases if p.swing is not None]
        if not swings or push.step >= len(swings):
            raise SceneError(f"[push] step is {push.step}; the walk has {len(swings)} steps, counted from 0")
        rng = np.random.default_rng([seed, 0xB0])
        self.step = int(rng.integers(len(swings))) if push.step < 0 else push.step
        phase = swings[self.step]
        self.start = phase.start + push.phase * (phase.end - phase.start)
        self.end = self.start + push.duration
        self._force = np.array(_DIRECTIONS[self.direction]) * (push.impulse / push.duration)

    def apply(self, world: World) -> None:
        """Set the external force on the torso for the next physics step."""
        time = world.data.time + 1e-9
        if time < self.start:
            return
        world.data.xfrc_applied[world.torso, :3] = self._force if time < self.end else 0.0
