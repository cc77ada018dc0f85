"""What the figures say of a scene's own settings: whether a cheaper one would do, or a finer one is wanted."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from plantar.sim.bench.scenes.scene_row import NOISE, SceneRow
from plantar.sim.bench.scenes.scene_setting import OWN

__all__ = ["KnobVerdict", "knob_verdicts"]

_WORTH = 0.95  # of the time: a setting that saves less than a twentieth is no reason to change anything


class KnobVerdict(NamedTuple):
    """What the rows of one knob state.

    Attributes:
        scene: Name of the scene.
        robot: Name of the robot.
        knob: The knob.
        stays: Whether the scene's own value is confirmed.
        reason: Why, in words.
    """

    scene: str
    robot: str
    knob: str
    stays: bool
    reason: str


def knob_verdicts(rows: Sequence[SceneRow]) -> list[KnobVerdict]:
    """Judge each knob of each scene by what sensor noise does to the same walk.

    A value is good enough where it walks and is no farther from its reference than noise moves the walk (centre of
    mass, ZMP and forces). The scene's own is confirmed where it is good enough and no such value saves a twentieth of
    the time. Knobs of the machine are the papers', and only recognised by how much the finest differs.

    Args:
        rows: What `scene_rows` gave.

    Returns:
        A verdict for each knob of each scene and robot that has a row of noise.
    """
    found = []
    for case in dict.fromkeys((r.scene, r.robot, r.walk) for r in rows):
        mine = [r for r in rows if (r.scene, r.robot, r.walk) == case]
        noise = next((r for r in mine if r.setting == NOISE), None)
        if noise is None:
            continue
        for knob in dict.fromkeys(r.knob for r in mine if r.setting not in (OWN.name, NOISE, r.against)):
            values = [r for r in mine if r.knob == knob and r.setting != r.against]
            own = next((r for r in mine if r.setting == OWN.name and r.against == values[0].against), None)
            if own is not None:
                found.append(KnobVerdict(case[0], case[1], knob, *_verdict(own, values, noise)))
    return found


def _verdict(own: SceneRow, values: Sequence[SceneRow], noise: SceneRow) -> tuple[bool, str]:
    if values[0].machine:
        size = "no more than noise does" if own.within(noise) else "more than noise does"
        return True, f"as the papers' robots have it; the finest moves the walk by {_errors(own)}: {size}"
    cheaper = [r for r in values if r.ratio <= _WORTH]
    do = sorted((r for r in cheaper if r.within(noise)), key=lambda r: r.ratio)
    if do:
        best = do[0]
        saved = f"{100 * (1 - best.ratio):.0f} % less time"
        return False, f"{best.value} would do: {saved}, CoM {best.com_mm:.2f} mm off, within noise"
    if not own.within(noise):
        finer = sorted((r for r in values if r.within(noise)), key=lambda r: r.ratio)
        if finer:
            return (
                False,
                f"differs by more than noise ({_errors(own)}); {finer[0].value} does not, at {finer[0].ratio:.2f} x",
            )
        return True, f"differs by more than noise ({_errors(own)}), and so does all else of the knob"
    if not cheaper:
        return True, f"{_errors(own)}, within noise; nothing else saves a twentieth of the time"
    worse = min(cheaper, key=lambda r: r.com_mm if r.walked else float("inf"))
    lost = "does not walk" if not worse.walked else _errors(worse)
    return True, f"{_errors(own)}, within noise; {worse.value} saves {100 * (1 - worse.ratio):.0f} % but: {lost}"


def _errors(row: SceneRow) -> str:
    return f"CoM {row.com_mm:.2f} mm, ZMP {row.zmp_mm:.1f} mm, forces {100 * row.force:.1f} %"
