"""Lists of robots, scenes, formats and settings, and a scene's shares of a body in numbers of its robot."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

from plantar.errors import InputError
from plantar.files.structured_text import described_files, packaged_files
from plantar.gait.controller_tables import CONTROLLER_TABLES, controller_settings_described
from plantar.settings.body_scale import REFERENCE_BODY, BodyScale, si_unit
from plantar.settings.schema import Setting, Settings
from plantar.sim.companion.experiment import companion_tables, experiment_names
from plantar.sim.papers.preset import paper_files
from plantar.sim.run.scene import SECTIONS, Scene
from plantar.sim.terrain import terrain_kinds

__all__ = ["body_told", "listed", "settings_listed", "settings_of_robot", "shares_told"]


def settings_listed(name: str | None = None, body: BodyScale = REFERENCE_BODY) -> dict[str, Setting]:
    """The settings by their dotted names.

    Args:
        name: A table such as "estimator" or "terrain.beam", a setting's dotted name, or its last part; None lists all.
        body: Its defaults are given in SI.

    Returns:
        Descriptions; those of a kind of terrain are listed under "terrain.KIND.", which a scene writes as
        `terrain.kind` and the last part; those of an experiment under its name.

    Raises:
        InputError: If there is no such table or setting.

    Example:
        >>> settings_listed("estimator.gravity")["estimator.gravity"][1:4]
        ('0.2002', '1/s', 'a number 0 to 50')
    """
    tables: dict[str, tuple[Setting, ...]] = {
        section: kind.described(body) for section, kind in SECTIONS.items() if section != "terrain"
    }
    tables |= {f"terrain.{kind}": ground.described(body) for kind, ground in terrain_kinds().items()}
    tables |= {table: controller_settings_described(table, body) for table in CONTROLLER_TABLES}
    for kind in experiment_names():
        tables |= {f"{kind}.{table}": own.described(body) for table, own in companion_tables(kind).items()}
    every = {f"{table}.{setting.name}": setting for table, settings in tables.items() for setting in settings}
    if name is None:
        return every
    found = {
        full: setting
        for full, setting in every.items()
        if full == name or full.startswith(f"{name}.") or full.endswith(f".{name}")
    }
    if not found:
        words = {*tables, *every, *(setting.name for setting in every.values())}
        near = get_close_matches(name, sorted(words), 4)
        hint = f"nearest: {', '.join(near)}; " if near else ""
        raise InputError(f"no setting or table '{name}'; {hint}tables: {', '.join(tables)}")
    return found


def settings_of_robot(name: str | None, robot: str | None) -> dict[str, Setting]:
    """Returns the settings of a `name` (see `settings_listed`) with the numbers of a `robot`, H1's for None.

    Raises:
        InputError: If there is no such table or setting.
        RobotError: If the robot is unknown or its model cannot be read.
    """
    if robot is None:
        return settings_listed(name)
    from plantar.robots import load_robot
    from plantar.robots.kinematics.body import body_of
    from plantar.robots.kinematics.robot_model import build_leg_model

    found = load_robot(robot)
    return settings_listed(name, body_of(found, build_leg_model(found).model))


def listed(what: str) -> dict[str, str]:
    """Names with a line that describes each.

    Args:
        what: "robots", "scenes", "papers" or "formats".

    Returns:
        Descriptions by name.

    Raises:
        InputError: If something else is asked for.

    Example:
        >>> "h1" in listed("robots"), "beam" in listed("scenes")
        (True, True)
    """
    if what == "formats":
        from plantar.formats import formats

        return {f.name: f"{f.title} ({', '.join(f.suffixes)})" for f in formats().values()}
    if what == "robots":
        files = packaged_files("plantar.robots", "*/robot.toml")
        files += packaged_files("plantar.sim", "companion/machines/*/machine.toml")
        return {path.parent.name: text for path, text in described_files(files).items()}
    if what == "scenes":
        return {
            path.stem: text for path, text in described_files(packaged_files("plantar.sim", "scenes/*.toml")).items()
        }
    if what == "papers":
        found = paper_files()
        return dict(zip(found, described_files(found.values()).values(), strict=True))
    raise InputError(f"cannot list '{what}'; allowed: robots, scenes, papers, formats, settings")


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
