"""Whether anything but its soles touches the ground: a robot that kneels does not walk."""

from typing import Any

import numpy as np

from plantar.sim.judging.unmet import unmet
from plantar.sim.model.world import World


class OtherContact:
    """Follows contacts of the robot's other parts with the ground of a `world`.

    Attributes:
        duration: In s, in all.
        first: Time in s of the first contact and the part, or None.
    """

    def __init__(self, world: World) -> None:
        model = world.model
        self._world = world
        self._robot = model.body_rootid[model.geom_bodyid] == model.body_rootid[world.torso]
        self._soles = np.zeros(model.ngeom, dtype=bool)
        for geoms in world.sole_geoms.values():
            self._soles[list(geoms)] = True
        self.duration = 0.0
        self.first: tuple[float, str] | None = None

    def step(self) -> None:
        """After each physics step in which not all contacts are the soles'."""
        data = self._world.data
        part = self._part(data.contact.geom)
        if part is None:
            return
        self.duration += self._world.period
        if self.first is None:
            self.first = (float(data.time), part)

    def _part(self, pairs: Any) -> str | None:
        for pair in pairs.tolist():
            own = [geom for geom in pair if geom >= 0 and self._robot[geom]]
            if len(own) == 1 and not self._soles[own[0]]:
                model = self._world.model
                return str(model.body(int(model.geom_bodyid[own[0]])).name) or "a leg"
        return None

    def reasons(self) -> list[dict[str, Any]]:
        """Failed criteria, as `plantar.sim.judging.unmet`."""
        time, part = self.first or (0.0, "")
        text = f"{part} touched the ground, first at {time:.2f} s, for {self.duration:.3f} s in all"
        return unmet((self.first is None, "ground_contact", round(self.duration, 4), 0.0, text))
