"""How steadily the ground carries: flickering contacts do not measure a controller."""

from typing import Any

from plantar.kernels.contacts.ground_reaction import GroundReaction
from plantar.kernels.judging.stance_force import StanceForce
from plantar.sim.model.world import World

RIPPLE = 0.02
"""Largest root mean square of the ground's vertical force less m (g + z'') in single support, over the weight."""

EDGE = 2e-3
"""Distance in m from the edge of the support below which the ZMP is at it."""

SETTLED = 0.1
"""Time in s after a landing that is left out of the force."""

SPAN = 0.01
"""Time in s, each way, over which the CoM's acceleration z'' is taken."""


class StanceRipple:
    """Watches the `reaction` in single support in a `world`; feet touch from `least` in N."""

    def __init__(self, world: World, reaction: GroundReaction, least: float) -> None:
        steps = max(1, round(SPAN / world.period)), round(SETTLED / world.period)
        mass = float(world.model.body_subtreemass[world.torso])
        gravity = -float(world.model.opt.gravity[2])
        center = world.data.subtree_com[world.torso]
        self.watch = StanceForce(reaction, center, mass, gravity, world.period, steps, least, EDGE)
        self._weight = mass * gravity

    @property
    def rms(self) -> float | None:
        """RMS of the force less m (g + z''), over the weight, or None."""
        return float(self.watch.rms()) / self._weight if self.watch.compared else None

    @property
    def edge_share(self) -> float | None:
        """Share of single support with the true ZMP at the edge, or None."""
        return self.watch.at_edge / self.watch.single if self.watch.single else None

    def summary(self) -> dict[str, float | None]:
        """The figures, rounded."""
        rms = self.rms
        share = self.edge_share
        return {
            "stance_force_rms": None if rms is None else round(rms, 5),
            "zmp_edge_share": None if share is None else round(share, 5),
        }

    def reasons(self) -> list[dict[str, Any]]:
        """Failed criteria, as `verdict.reasons`."""
        value = self.rms
        if value is None or value <= RIPPLE:
            return []
        text = f"the ground's force rippled by {value:.2g} of the weight in single support; allowed: {RIPPLE:g}"
        text += ", more is a contact that flickers"
        return [{"criterion": "stance_force", "value": round(value, 5), "limit": RIPPLE, "text": text}]
