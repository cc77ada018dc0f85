"""Whether one leg touches the other."""

from plantar.common.sides import SIDES
from plantar.robots.leg_shapes import COLLIDES
from plantar.sim.model.world import World


def legs_that_touch(world: World) -> tuple[str, str] | None:
    """Both links of the first contact between the legs in a `world`, or None."""
    model = world.model
    for pair in world.data.contact.geom.tolist():
        sides = {int(model.geom_contype[g]): g for g in pair if g >= 0}
        found = [sides.get(COLLIDES[side][0]) for side in SIDES]
        if None not in found:
            left, right = (model.body(int(model.geom_bodyid[g])).name for g in found)
            return left or "left leg", right or "right leg"
    return None


class LegContact:
    """Follows contacts between legs or soles in a `world`.

    `duration` in s, in all; `first`: time in s of the first contact and both links, or None.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._sensed = world.data.sensordata
        self._address = world.leg_contact
        self.duration = 0.0
        self.first: tuple[float, str, str] | None = None

    def step(self) -> None:
        """After each physics step."""
        if not self._sensed.item(self._address) > 0.0:
            return
        self.duration += self._world.period
        if self.first is None:
            links = legs_that_touch(self._world)
            if links is not None:
                self.first = (float(self._world.data.time), *links)
