"""Subject and device of a recording."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.formats import formats
from plantar.recordings.pressure_recording import PressureRecording

BODY_MASSES = (2.0, 400.0)
FOOT_LENGTHS = (0.05, 0.45)
"""Masses in kg and lengths of a foot in m, smallest and largest, that are believed of people and robots."""

# Share by which the weight that forces imply may differ from the stated one: more than an insole that fits badly
# misses, less than any unit is off that is mistaken for another.
_DISAGREE = 0.3


@dataclass(frozen=True)
class Subject:
    """Person or robot, if known.

    `name`: name or number, or empty; `mass_kg`: body mass in kg, or None; `foot_length_m` in m, or None.
    """

    name: str = ""
    mass_kg: float | None = None
    foot_length_m: float | None = None

    def __post_init__(self) -> None:
        checked = (("mass", self.mass_kg, "kg", BODY_MASSES), ("foot-length", self.foot_length_m, "m", FOOT_LENGTHS))
        for name, value, unit, (low, high) in checked:
            if value is not None and not low <= value <= high:
                raise InputError(f"--{name} is {value:g}; allowed: {low:g} to {high:g} {unit}")

    @property
    def weight(self) -> float | None:
        """Weight in N; None without mass."""
        return None if self.mass_kg is None else self.mass_kg * GRAVITY


def subject_of(recording: PressureRecording, given: Subject | None) -> Subject:
    """Returns the `given` subject, completed by the name and mass that a robot's `recording` holds."""
    subject = given or Subject()
    if recording.kind != "robot":
        return subject
    name = recording.metadata.get("robot")
    mass = recording.metadata.get("mass_kg")
    if not (isinstance(mass, int | float) and BODY_MASSES[0] <= mass <= BODY_MASSES[1]):
        mass = None
    return replace(
        subject, name=subject.name or (name if isinstance(name, str) else ""), mass_kg=subject.mass_kg or mass
    )


def mass_doubts(subject: Subject, implied: float | None) -> list[str]:
    """Returns warning where a recording's implied weight in N contradicts the subject's mass."""
    weight = subject.weight
    if weight is None or implied is None or abs(implied / weight - 1.0) <= _DISAGREE:
        return []
    lost = ", the sensor's zero (what it reads below zero may be cut off)" if implied < weight else ""
    return [
        f"the forces imply {implied / GRAVITY:.3g} kg, the stated mass is {subject.mass_kg:.3g} kg: check the unit, "
        f"the insole's size{lost} and the mass"
    ]


def device_of(recording: PressureRecording) -> dict[str, Any]:
    """Device of a recording, if the file states it.

    Returns "name" (of the format), "sensor" (the file's name, or None), and for each foot with geometry "layout",
    "cells", and the sole's or platform's "length_m" and "width_m".
    """
    known = formats().get(recording.format)
    facts = recording.metadata
    stated = (facts.get(key) for key in ("sensor", "sensors", "sensor insoles", "robot"))
    sensor = next((s for s in stated if s), None)
    feet: dict[str, Mapping[str, Any]] = {}
    for side, foot in recording.feet.items():
        if foot.layout is not None:
            length, width = (float(v) for v in np.ptp(foot.layout.outline, axis=0)[:2])
            size = {"length_m": length, "width_m": width}
            feet[side] = {"layout": foot.layout.name, "cells": len(foot.layout), **size}
    name = recording.format if known is None else known.title.partition(", with ")[0]
    return {"name": name, "sensor": ", ".join(sensor) if isinstance(sensor, list) else sensor, "feet": feet}
