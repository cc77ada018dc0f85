"""What a reader of an analysis may decide: which steps count, whose events, and whether baselines are taken off."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from plantar.errors import InputError

__all__ = ["ACTIVITIES", "AnalysisOptions", "steps_of_text"]

ACTIVITIES = ("walking", "running", "hopping")
"""Activities of steps that segments are of."""


@dataclass(frozen=True)
class AnalysisOptions:
    """Decisions of an analysis.

    Attributes:
        steps: First and last number of the steps of each foot that are in the means; "steady" for those of steady
        walking,
            "all" for all complete ones.
        begin: Time in s before which no step counts.
        end: Time in s after which no step counts.
        segment: The activity whose steps are in the means, such as "walking"; the one with most steps where None.
        baseline: "auto" takes off what sensors read in swing where that is an offset; "keep" leaves it.
        events: "own" finds the events in the force; "vendor" takes those that the file states; else the path of a file
            of events, such as a vendor's report (see `plantar.formats.stated_events`).
    """

    steps: tuple[int, int] | Literal["steady", "all"] = "steady"
    begin: float | None = None
    end: float | None = None
    segment: str | None = None
    baseline: Literal["auto", "keep"] = "auto"
    events: str = "own"

    def __post_init__(self) -> None:
        if self.baseline not in ("auto", "keep"):
            raise InputError(f"--baseline is {self.baseline!r}; allowed: auto, keep")
        if self.segment not in (None, *ACTIVITIES):
            raise InputError(f"--segment is {self.segment!r}; allowed: {', '.join(ACTIVITIES)}")
        if self.begin is not None and self.end is not None and not self.begin < self.end:
            raise InputError(f"--from {self.begin:g} is not before --to {self.end:g}")

    @property
    def events_file(self) -> str | None:
        """Path of the file of events; None where they are found in the force, or stated by the recording."""
        return None if self.events in ("own", "vendor") else self.events

    def of_several(self, what: str) -> None:
        """Refuse what can hold of one recording alone: a file of events has the times of one walk.

        Args:
            what: What takes several, the subject of the error.

        Raises:
            InputError: If the events are those of a file.
        """
        if self.events_file is not None:
            text = f"a file of events is of one recording, and {what} several; allowed: own, vendor"
            raise InputError(f"--events {self.events}: {text}")


def steps_of_text(text: str | None) -> tuple[int, int] | Literal["steady", "all"]:
    """Which steps a text names.

    Args:
        text: "3-14", "5", "steady" or "all"; None for "steady".

    Returns:
        The first and the last step, or the word.

    Raises:
        InputError: If it is none of these.

    Example:
        >>> steps_of_text("3-14"), steps_of_text("5"), steps_of_text(None)
        ((3, 14), (5, 5), 'steady')
    """
    if text is None or text == "steady":
        return "steady"
    if text == "all":
        return "all"
    match = re.fullmatch(r"\s*(\d{1,6})\s*(?:-\s*(\d{1,6})\s*)?", text)
    first, last = (int(match[1]), int(match[2] or match[1])) if match else (1, 0)
    if not 1 <= first <= last:
        raise InputError(f"--steps is {text!r}; allowed: a number or a range such as 3-14 from 1 on, steady, all")
    return first, last
