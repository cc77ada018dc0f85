"""Options of an analysis: steps in the means, events and baselines."""

import math
import re
from dataclasses import dataclass
from typing import Literal, cast

from plantar.errors import InputError
from plantar.gait.analysis.masks import SEVEN_MASKS, Masks

ACTIVITIES = ("walking", "running", "hopping")
"""Activities of steps that segments are of."""

_HIGHEST = 500.0  # N


@dataclass(frozen=True)
class AnalysisOptions:
    """Analysis choices.

    `steps`: first and last step number of each foot in the means; "steady" for steady walking, "all" for all complete
    ones; `begin`: time in s before which steps do not count; `end`: time in s after which steps do not count;
    `segment`: activity in the means, such as "walking"; the one with most steps where None; `baseline`: "auto" removes
    swing readings that are an offset; "keep" leaves them; `events`: "own" finds events in the force; "vendor" uses
    those stored in the file; else the path of an events file (see `plantar.formats.stated_events`); `threshold`: force
    in N whose crossings are the events, as a protocol may state; `masks`: regions that are measured.
    """

    steps: tuple[int, int] | Literal["steady", "all"] = "steady"
    begin: float | None = None
    end: float | None = None
    segment: str | None = None
    baseline: Literal["auto", "keep"] = "auto"
    events: str = "own"
    threshold: float | None = None
    masks: Masks = SEVEN_MASKS

    def __post_init__(self) -> None:
        if self.threshold is not None and not 0.0 < self.threshold < _HIGHEST:
            raise InputError(f"--threshold is {self.threshold:g} N; allowed: above 0, below {_HIGHEST:g}")
        if self.threshold is not None and self.events != "own":
            raise InputError(f"--threshold is for events in the force; --events is {self.events!r}; allowed: own")
        if self.baseline not in ("auto", "keep"):
            raise InputError(f"--baseline is {self.baseline!r}; allowed: auto, keep")
        if self.segment not in (None, *ACTIVITIES):
            raise InputError(f"--segment is {self.segment!r}; allowed: {', '.join(ACTIVITIES)}")
        begin = -math.inf if self.begin is None else self.begin
        end = math.inf if self.end is None else self.end
        if not begin < end:
            raise InputError(f"--from {begin:g} is not before --to {end:g}")
        known = self.steps in ("steady", "all")
        first, last = cast(tuple[int, int], self.steps) if len(self.steps) == 2 else (1, int(known))
        if not 1 <= first <= last:
            raise InputError(f"steps are {self.steps!r}; allowed: first and last from 1 on, steady, all")

    @property
    def events_file(self) -> str | None:
        """Path of the events file, if any."""
        return None if self.events in ("own", "vendor") else self.events

    def of_several(self, what: str) -> None:
        """Raise InputError if events come from a file of one recording; `what` is the message's subject."""
        if self.events_file is not None:
            text = f"a file of events is of one recording, and {what} several; allowed: own, vendor"
            raise InputError(f"--events {self.events}: {text}")


def steps_of_text(text: str | None) -> tuple[int, int] | Literal["steady", "all"]:
    """First and last step, or "steady" or "all", of text such as "3-14", "5" or None ("steady"); else InputError.

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
