"""A scene's shares of a body in numbers of the robot that walks in it."""

from __future__ import annotations

from typing import Any

from plantar.settings.body_scale import BodyScale, si_unit
from plantar.settings.schema import Settings
from plantar.sim.run.scene import SECTIONS, Scene

__all__ = ["body_told", "shares_told"]


def body_told(body: BodyScale) -> dict[str, float]:
    """Size of a body by name and unit, as plain JSON values."""
    return {
        "mass_kg": round(body.mass, 4),
        "weight_N": round(body.weight, 3),
        "leg_m": round(body.leg, 6),
        "sole_m": round(body.sole, 6),
        "sole_width_m": round(body.sole_width, 6),
        "beat_s": round(body.beat, 6),
        "pace_s": round(body.pace, 6),
    }


def shares_told(scene: Scene) -> dict[str, dict[str, Any]]:
    """ "share", "value" in SI and "unit" of a scene's settings that are shares of a body, by dotted name.

    The scene is one of a robot (`Scene.for_body`).

    Example:
        >>> from plantar.sim.run.scene import load_scene
        >>> shares_told(load_scene("flat"))["walk.length"]
        {'share': '0.3333 leg', 'value': 0.2, 'unit': 'm'}
    """
    return {
        f"{section}.{name}": share for section in SECTIONS for name, share in _told(getattr(scene, section)).items()
    }


def _told(settings: Settings) -> dict[str, dict[str, Any]]:
    return {
        name: {
            "share": str(share),
            "value": float(f"{getattr(settings, name):.6g}"),
            "unit": si_unit(share.unit),
        }
        for name, share in settings.stated.items()
    }
