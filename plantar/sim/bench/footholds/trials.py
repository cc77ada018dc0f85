"""Ground and pushes in units of the robot, so that robots compare."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from plantar.sim.run.scene import Scene, scene_of

__all__ = ["TRIALS", "Trial", "scene_of_trial"]

_STEPS = 8
_FORWARD = {"steps": _STEPS, "length": "1/3 leg"}
_SIDEWAYS = {"steps": _STEPS, "length": 0.0, "sideways": "2/15 leg"}


class Trial(NamedTuple):
    """A kind of ground or push at one difficulty.

    Attributes:
        kind: "beam", "stones", "slopes", "steps" or "push".
        value: Difficulty, in the unit.
        unit: What the value is a share of.
        tables: Tables of the scene.
    """

    kind: str
    value: float
    unit: str
    tables: Mapping[str, Mapping[str, Any]]


def _trials() -> list[Trial]:
    found = [Trial("flat", 0.0, "", {"terrain": {"kind": "flat"}, "walk": _FORWARD})]
    for share in (0.8, 0.5, 0.33, 0.25):
        beam = {"kind": "beam", "width": f"{share} sole", "length": "13/6 leg", "offset_range": f"{share / 3} sole"}
        found.append(Trial("beam", share, "foot's extent across it", {"terrain": beam, "walk": _SIDEWAYS}))
    for share in (0.8, 0.6, 0.4, 0.2):
        stones = {"kind": "stones", "share_min": share, "share_max": min(1.0, share + 0.2)}
        found.append(Trial("stones", share, "sole, smallest stone", {"terrain": stones, "walk": _FORWARD}))
    for degrees in (2.0, 5.0, 8.0):
        slopes = {"kind": "uneven", "height_range": 0.0, "slope_range": degrees}
        found.append(Trial("slopes", degrees, "deg", {"terrain": slopes, "walk": _FORWARD}))
    for height in (0.0125, 0.025, 0.05):
        uneven = {"kind": "uneven", "height_range": f"{height} leg"}
        found.append(Trial("steps", height, "leg, up or down", {"terrain": uneven, "walk": _FORWARD}))
    for speed in (0.05, 0.1, 0.15):
        push = {"dv": f"{speed} leg/beat"}
        found.append(Trial("push", speed, "sqrt(g l)", {"terrain": {"kind": "flat"}, "walk": _FORWARD, "push": push}))
    return found


TRIALS = tuple(_trials())
"""All trials, each kind from easy to hard. The first is flat ground."""


def scene_of_trial(trial: Trial, robot: str) -> Scene:
    """Returns the scene of a `trial` for a `robot`; readings of the soles arrive one period late."""
    name = f"{trial.kind}-{trial.value:g}"
    source = {"name": name, "sensing": {"delay_periods": 1}, **trial.tables}
    return scene_of(source, Path(f"{name}.toml"), (), robot)
