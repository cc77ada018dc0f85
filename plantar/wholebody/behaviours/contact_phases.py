"""A hand's two contact phases, and the weight from proximity to force (A Table 1, 3.1)."""

from collections.abc import Sequence

from plantar.wholebody.fusion.priority_transition import smooth_share
from plantar.wholebody.tasks.task import Task


class ContactPhases:
    """Precontact and contact: tasks of each, entered when the user reports it.

    `precontact`: levels before: distance, compliant wrist, tactile guidance, base avoidance and posture; `contact`:
    levels in contact: force, compliant wrist, position, and compliance with base avoidance and posture; `duration` of
    the sigmoid of w (A 6) from 0 to 1 in s; 0 jumps.
    """

    def __init__(
        self,
        precontact: Sequence[Sequence[Task]],
        contact: Sequence[Sequence[Task]],
        duration: float = 2.0,
    ) -> None:
        self.duration = duration
        self.in_contact = False
        self._arrangements = (precontact, contact)
        self._since = float("-inf")
        self._from = 0.0

    @property
    def levels(self) -> Sequence[Sequence[Task]]:
        return self._arrangements[self.in_contact]

    def enter(self, in_contact: bool, time: float) -> bool:
        """Enter a phase at a `time` in s, that of contact if `in_contact`; the weight continues from its value.

        Returns whether the phase changed: begin a priority transition.
        """
        if in_contact == self.in_contact:
            return False
        self._from = self.weight(time)
        self._since = time
        self.in_contact = in_contact
        return True

    def weight(self, time: float) -> float:
        """w of A 6 at a time in s: 0 for proximity alone, 1 for force alone."""
        share = smooth_share(time - self._since, self.duration)
        return self._from + share * (float(self.in_contact) - self._from)
