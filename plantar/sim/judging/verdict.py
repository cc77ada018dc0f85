"""The verdict on a run: each failed criterion, value and limit."""

from dataclasses import dataclass
from typing import Any

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.mechanics.same_time import SAME_TIME
from plantar.sim.judging.joint_limits import JointLimits
from plantar.sim.judging.leg_contact import LegContact

POSITION = 1 / 6
"""Distance in leg lengths of the CoM from the walk's end that counts as there: 0.1 m for H1."""

HEADING = 5.0
"""Angle in degrees from the walk's last heading that counts as straight."""

UPRIGHT = 5.0
"""Tilt of the torso in degrees that counts as upright."""

FASTER_FOR = 0.02
"""Time in s for which a joint may be faster than its limit: four control periods, which no robot's size changes."""


@dataclass(frozen=True)
class Ending:
    """How a run ended.

    Attributes:
        fall: (criterion's value, limit, text), or None.
        stopped: The controller's final safe state, or None.
        missed: Why the first missing step failed.
        position: CoM's distance in m from the walk's end, or None.
        heading: Heading error in degrees, or None.
        tilt: Of the torso in degrees.
        overrun: Cut and first planned end in s, or None.
        raised: Ticks at which the controller raised, and the last error.
    """

    fall: tuple[float, float, str] | None
    stopped: str | None
    steps: tuple[int, int]
    missed: str
    position: float | None
    heading: float | None
    tilt: float
    body: BodyScale = REFERENCE_BODY
    pushes: tuple[int, int] = (0, 0)
    overrun: tuple[float, float] | None = None
    raised: tuple[int, str] = (0, "")


def reasons(ending: Ending, legs: LegContact, joints: JointLimits) -> list[dict[str, Any]]:
    """Returns failed criteria of an `ending`, contacts of `legs` and speeds of `joints`: "criterion", "value", "limit",
    "text".
    """
    found: list[dict[str, Any]] = []

    def add(criterion: str, value: float, limit: float, text: str) -> None:
        found.append({"criterion": criterion, "value": value, "limit": limit, "text": text})

    if ending.fall is not None:
        value, limit, text = ending.fall
        add("fall", round(value, 6), round(limit, 6), text)
    if ending.stopped is not None:
        add("emergency_stop", 1, 0, f"the controller stopped for good: {ending.stopped}")
    raised, error = ending.raised
    if raised:
        add(
            "controller_error",
            raised,
            0,
            f"the controller raised at {raised} ticks and held; the last: {error}",
        )
    if ending.overrun is not None:
        time, planned_end = ending.overrun
        text = f"the controller still put its end off at {time:.0f} s, where the run was cut off"
        add("overrun", round(time, 3), round(planned_end, 3), text)
    if legs.first is not None:
        time, one, other = legs.first
        text = f"{one} touched {other}, first at {time:.2f} s, for {legs.duration:.3f} s in all"
        add("collision", round(legs.duration, 4), 0.0, text)
    longest = float(joints.longest.max())
    if longest > FASTER_FOR + SAME_TIME:
        k = int(joints.longest.argmax())
        share = float(joints.fastest[k])
        text = f"{joints.names[k]} was faster than its limit for {longest:.3f} s, by {share:.2f} times at most"
        add("joint_speed", round(longest, 4), FASTER_FOR, text)
    taken, planned = ending.steps
    if taken < planned:
        add("steps", taken, planned, f"{taken} of {planned} steps; step {taken} (from 0): {ending.missed}")
    recovered, pushes = ending.pushes
    if recovered < pushes:
        add("pushes", recovered, pushes, f"recovered from {recovered} of {pushes} pushes")
    ends: tuple[tuple[str, float | None, float, str, str], ...] = (
        (
            "position",
            ending.position,
            round(POSITION * ending.body.leg, 4),
            "m",
            "the CoM ended {} from the walk's end",
        ),
        ("heading", ending.heading, HEADING, "deg", "the torso ended turned by {}"),
        ("tilt", ending.tilt, UPRIGHT, "deg", "the torso ended tilted by {}"),
    )
    for criterion, off, limit, unit, text in ends:
        if off is not None and not off < limit:
            words = f"{text.format(f'{off:.3g} {unit}')}; allowed: less than {limit:g} {unit}"
            add(criterion, round(off, 4), limit, words)
    return found
