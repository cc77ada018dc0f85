"""Pressure-driven interaction: a force on a small area moves the robot more than one on a large area (T 3.26-3.28)."""

from __future__ import annotations

from collections.abc import Sequence

from plantar.sensing.link_skin import BodySkin, LinkWrench, SkinReading
from plantar.wholebody.tasks.interaction import DirectInteraction

__all__ = ["PressureInteraction"]


class PressureInteraction(DirectInteraction):
    """Yields to w_P = xi / (sum of active areas) w_f on each link (T 3.27).

    Args:
        sensitivity: xi in m^2: the area over which a force counts as it is.
        patches: Names of the patches that count; all where None.
    """

    def __init__(self, skin: BodySkin, sensitivity: float, patches: Sequence[str] | None = None) -> None:
        super().__init__(skin, patches=patches)
        self.sensitivity = sensitivity

    def wrenches(self, skin: SkinReading) -> list[LinkWrench]:
        """The amplified wrench w_P of each link that is touched, in the link's frame (T 3.26-3.27)."""
        found = super().wrenches(skin)
        areas = [float(self.skin.areas[w.taxels].sum()) for w in found]
        return [w._replace(wrench=self.sensitivity / a * w.wrench) for w, a in zip(found, areas, strict=True)]
