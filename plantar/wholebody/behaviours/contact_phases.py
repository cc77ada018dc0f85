"""The two phases of contact of a hand, and the weight from proximity to force (A Table 1, 3.1)."""

from __future__ import annotations

from collections.abc import Sequence

from plantar.settings.schema import Settings, number
from plantar.wholebody.fusion.priority_transition import smooth_share
from plantar.wholebody.tasks.task import Task

__all__ = ["ContactPhases", "PhaseSettings"]


class PhaseSettings(Settings):
    """How fast the weight changes.

    Attributes:
        duration: Time in s in which w of A 6 goes from 0 to 1 along a sigmoid.
    """

    duration: float = number(2.0, "s", 0.0, 60.0)


class ContactPhases:
    """Precontact and contact: an arrangement of tasks each, entered when the user reports it.

    Args:
        precontact: Levels before contact: distance, compliant wrist, tactile guidance, base avoidance and posture.
        contact: Levels in contact: force, compliant wrist, position, and compliance with base avoidance and posture.
        settings: How fast the weight changes.

    Attributes:
        in_contact: Whether the contact phase counts.
        levels: The current levels.
    """

    def __init__(
        self,
        precontact: Sequence[Sequence[Task]],
        contact: Sequence[Sequence[Task]],
        settings: PhaseSettings | None = None,
    ) -> None:
        self.settings = settings or PhaseSettings()
        self.in_contact = False
        self._arrangements = (precontact, contact)
        self._since = float("-inf")
        self._from = 0.0

    @property
    def levels(self) -> Sequence[Sequence[Task]]:
        return self._arrangements[self.in_contact]

    def enter(self, in_contact: bool, time: float) -> bool:
        """Enter a phase; the weight continues from its current value.

        Args:
            in_contact: Whether that is the contact phase.
            time: Time in s.

        Returns:
            Whether that changed the phase: then a transition of priorities begins.
        """
        if in_contact == self.in_contact:
            return False
        self._from, self._since = self.weight(time), time
        self.in_contact = in_contact
        return True

    def weight(self, time: float) -> float:
        """w of A 6 at a time in s: 0 for proximity alone, 1 for force alone."""
        share = smooth_share(time - self._since, self.settings.duration)
        return self._from + share * (float(self.in_contact) - self._from)
