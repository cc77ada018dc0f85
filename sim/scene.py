"""A scene is data: a TOML that names terrain, robot, gait, what is sensed and what disturbs.

Reading a scene needs no simulator; `plantar list scenes` uses it too.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from plantar.errors import SceneError
from plantar.unknown_keys import refuse_unknown_keys
from sim.table import from_table, limits
from sim.terrain import TERRAIN_KINDS, Flat, Terrain

__all__ = ["Control", "Push", "Scene", "Sensing", "Walk", "builtin_scenes", "load_scene", "override"]

_FOLDER = Path(__file__).parent / "scenes"


@dataclass(frozen=True)
class Walk:
    """Gait of a scene. Lengths in m, times in s.

    Attributes:
        steps: Number of steps; the last one closes the feet.
        length: Distance by which a step leads the other foot.
        sideways: Lateral distance by which each opening step leads, positive to the left.
        stance_width: Distance of the ankles when the feet stand side by side; 0 takes the robot's own.
        first: Foot that moves first.
        single_support: t_ss; 0 takes the robot's own.
        double_support: t_ds; 0 takes the robot's own.
        swing_height: Clearance of the swing foot.
        lean: Whether the trunk leans over the stance foot, which takes load off the hip roll joints (see the robot's
            `trunk_lean`).
        crouch: How much lower than its own CoM height the robot walks, to reach further and ground that is lower than
            expected; as far as the robot can (its `largest_crouch` and `largest_crouch_partial`).
        approach_height: Height above the expected ground from which the swing foot goes down slowly; it then aims as
            far below it, for ground that is lower than expected.
        approach_speed: Speed of that in m/s.
        start: Duration of the first weight shift.
        end: Duration of the last weight shift.
        settle: Standing time that is simulated after the walk.
        begin: Standing time before the walk; the CoM leads the first weight shift by about 1 s.
    """

    steps: int = field(default=20, metadata=limits(0, 100000))
    length: float = field(default=0.2, metadata=limits(-0.5, 0.5))
    sideways: float = field(default=0.0, metadata=limits(-0.3, 0.3))
    stance_width: float = field(default=0.0, metadata=limits(0.0, 0.6))
    first: str = field(default="left", metadata={"choices": ("left", "right")})
    single_support: float = field(default=0.0, metadata=limits(0.0, 10.0))
    double_support: float = field(default=0.0, metadata=limits(0.0, 10.0))
    swing_height: float = field(default=0.05, metadata=limits(0.005, 0.25))
    lean: bool = False
    crouch: float = field(default=0.0, metadata=limits(0.0, 0.15))
    approach_height: float = field(default=0.0, metadata=limits(0.0, 0.1))
    approach_speed: float = field(default=0.06, metadata=limits(0.005, 0.5))
    start: float = field(default=1.2, metadata=limits(0.2, 60.0))
    end: float = field(default=1.0, metadata=limits(0.2, 60.0))
    settle: float = field(default=2.0, metadata=limits(0.0, 600.0))
    begin: float = field(default=1.0, metadata=limits(1.0, 60.0))


@dataclass(frozen=True)
class Sensing:
    """What the sensors do to the truth. Standard deviations (1 sigma) of white noise; SI.

    Attributes:
        skin_rate: Sampling rate of the soles in Hz.
        force_noise: Of each taxel in N (0.15 kg).
        delay_periods: Whole skin periods between sampling and delivery.
        proximity_range: Range of the taxels' proximity sensors in m.
        proximity_noise: Of each proximity reading in m.
        proximity_bias: What every proximity reading is too long by in m; negative: too short.
        dead_taxels: Share of each sole's taxels that are dead; the seed chooses which.
        encoder_noise: Of each joint encoder in rad.
        gyro_noise: Of each gyro axis in rad/s.
        accelerometer_noise: Of each accelerometer axis in m/s^2.
        force_torque: Whether the ankles have force-torque sensors that somebody reads.
        ankle_force_noise: Of each axis of their force in N.
        ankle_torque_noise: Of each axis of their torque in N m.
    """

    skin_rate: float = field(default=250.0, metadata=limits(10.0, 1000.0))
    force_noise: float = field(default=1.4715, metadata=limits(0.0, 1000.0))
    delay_periods: int = field(default=0, metadata=limits(0, 250))
    proximity_range: float = field(default=0.05, metadata=limits(0.005, 0.5))
    proximity_noise: float = field(default=0.002, metadata=limits(0.0, 0.1))
    proximity_bias: float = field(default=0.0, metadata=limits(-0.05, 0.05))
    dead_taxels: float = field(default=0.0, metadata=limits(0.0, 0.9))
    encoder_noise: float = field(default=5e-5, metadata=limits(0.0, 0.1))
    gyro_noise: float = field(default=2e-3, metadata=limits(0.0, 1.0))
    accelerometer_noise: float = field(default=0.05, metadata=limits(0.0, 10.0))
    force_torque: bool = False
    ankle_force_noise: float = field(default=1.0, metadata=limits(0.0, 1000.0))
    ankle_torque_noise: float = field(default=0.05, metadata=limits(0.0, 100.0))


@dataclass(frozen=True)
class Push:
    """Pushes on the base: one in a step, or several while the robot stands.

    Attributes:
        impulse: Impulse in N s; 0 pushes nobody.
        duration: Duration in s.
        direction: Direction in the robot's frame, or "seeded": the seed chooses.
        step: Step in whose single support it comes; -1 lets the seed choose.
        phase: Share of the single support at which it begins.
        count: Number of pushes on a robot that stands; 0 pushes once, in a step.
        interval: Time in s from one such push to the next.
        sideways: Strength of a push to the side, as a share of one forward; in between along an ellipse.
        height: Height in m above the torso's centre of mass at which it is pushed; 0.6 is about the neck.
    """

    impulse: float = field(default=0.0, metadata=limits(0.0, 1000.0))
    duration: float = field(default=0.1, metadata=limits(0.001, 10.0))
    direction: str = field(default="seeded", metadata={"choices": ("seeded", "forward", "backward", "left", "right")})
    step: int = field(default=-1, metadata=limits(-1, 100000))
    phase: float = field(default=0.5, metadata=limits(0.0, 1.0))
    count: int = field(default=0, metadata=limits(0, 1000))
    interval: float = field(default=4.0, metadata=limits(0.1, 60.0))
    sideways: float = field(default=1.0, metadata=limits(0.0, 1.0))
    height: float = field(default=0.0, metadata=limits(-1.0, 1.0))


@dataclass(frozen=True)
class Control:
    """How the scene is controlled and computed.

    Attributes:
        feedback: False walks the plan in open loop.
        zmp_source: What feels the loads and the ZMP that are fed back: "skin", or "force_torque" at the ankles.
        footholds: What tells what a foot stands on: "off" takes every foothold for a whole sole; "force" goes by the
            taxels' forces, "skin" by what they see before they touch, too.
        pfc: Preemptive foot compliance: proximity stops the swing before the impact and turns the sole to the ground.
        feasibility: Rule by which a foothold is refused that is higher than expected: "off", "skin" (supported area) or
            "force_torque" (moment at the ankle). Needs pfc.
        conform: Feet take the ground's shape: standing soles turn until the ground carries them where they shall be
            loaded. For bumps; needs pfc.
        skip: "auto" computes what is needed; "none" computes everything, for comparison. The motion is the same.
    """

    feedback: bool = True
    zmp_source: str = field(default="skin", metadata={"choices": ("skin", "force_torque")})
    footholds: str = field(default="off", metadata={"choices": ("off", "force", "skin")})
    pfc: bool = False
    feasibility: str = field(default="off", metadata={"choices": ("off", "skin", "force_torque")})
    conform: bool = False
    skip: str = field(default="auto", metadata={"choices": ("auto", "none")})


_SECTIONS: dict[str, type] = {
    "terrain": Flat,  # or another of TERRAIN_KINDS, by its field `kind`
    "walk": Walk,
    "sensing": Sensing,
    "push": Push,
    "control": Control,
}

_ALIASES: Mapping[str, str] = {
    "sideways": "walk.sideways",
    "t_ss": "walk.single_support",
    "t_ds": "walk.double_support",
    "noise": "sensing.force_noise",
    "delay": "sensing.delay_periods",
}


@dataclass(frozen=True)
class Scene:
    """A scene.

    Attributes:
        name: Name.
        description: One line for people.
        robot: Name or TOML file of the robot.
        terrain: Ground.
        walk: Gait.
        sensing: Sensor noise and delay.
        push: Disturbance.
        control: Switches.
    """

    name: str
    description: str
    robot: str
    terrain: Terrain
    walk: Walk
    sensing: Sensing
    push: Push
    control: Control


def builtin_scenes() -> tuple[str, ...]:
    """Names of the built-in scenes."""
    return tuple(sorted(p.stem for p in _FOLDER.glob("*.toml")))


def override(source: Mapping[str, Any], settings: Sequence[str]) -> dict[str, Any]:
    """Apply `key=value` settings to a scene's tables.

    Args:
        source: The scene as read from TOML.
        settings: Each "section.key=value" or, where the key is unique, "key=value"; values are TOML, bare words texts.

    Returns:
        A changed copy.

    Raises:
        SceneError: If a key is unknown or a setting is not of that form.

    Example:
        >>> override({"walk": {"steps": 20}}, ["steps=4", "control.feedback=false"])
        {'walk': {'steps': 4}, 'control': {'feedback': False}}
    """
    result = {k: dict(v) if isinstance(v, Mapping) else v for k, v in source.items()}
    pairs: list[tuple[str, str]] = []
    for setting in settings:
        key, equals, text = setting.partition("=")
        key = _ALIASES.get(key.strip(), key.strip())
        if not equals or not key:
            raise SceneError(f"setting {setting!r} is not of the form key=value")
        if key in ("kind", "terrain.kind"):  # first: it decides which other keys there are
            terrain = result.setdefault("terrain", {})
            if isinstance(terrain, dict):
                terrain["kind"] = text.strip()
        else:
            pairs.append((key, text))
    keys = {name: [f.name for f in fields(kind)] for name, kind in (_SECTIONS | _terrain_kind(result)).items()}
    for key, text in pairs:
        if key == "robot":
            result["robot"] = text.strip()
            continue
        section, dot, name = key.rpartition(".")
        owners = [s for s, names in keys.items() if name in names and (not dot or s == section)]
        if len(owners) > 1:
            found = ", ".join(f"{s}.{name}" for s in owners)
            raise SceneError(f"setting '{key}={text}' could be more than one key; allowed: {found}")
        if not owners:
            allowed = ", ".join(f"{s}.{n}" for s, names in keys.items() for n in names)
            raise SceneError(f"setting '{key}={text}': no such key; allowed: robot, {allowed}")
        table = result.setdefault(owners[0], {})
        if not isinstance(table, dict):
            raise SceneError(f"scene section '{owners[0]}' is not a table")
        table[name] = _value(text.strip())
    return result


def _terrain_kind(source: Mapping[str, Any]) -> dict[str, type]:
    """The dataclass of a scene's terrain, as its section."""
    table = source.get("terrain", {})
    kind = table.get("kind", "flat") if isinstance(table, Mapping) else "flat"
    if not isinstance(kind, str) or kind not in TERRAIN_KINDS:
        raise SceneError(f"terrain.kind is {kind!r}; allowed: {', '.join(TERRAIN_KINDS)}")
    return {"terrain": TERRAIN_KINDS[kind]}


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"v = {text}")["v"]
    except tomllib.TOMLDecodeError:
        return text


def load_scene(name: str | os.PathLike[str], settings: Sequence[str] = (), robot: str | None = None) -> Scene:
    """Load a scene by its built-in name or from a TOML file.

    Args:
        name: A built-in name (`builtin_scenes()`) or the path of a scene TOML.
        settings: `key=value` settings that override the file's.
        robot: Robot to use instead of the file's.

    Returns:
        The scene.

    Raises:
        SceneError: If the name is unknown or a field is not valid; the message names it.

    Example:
        >>> load_scene("flat", ["steps=4"]).walk.steps
        4
    """
    path = Path(name)
    if path.suffix == ".toml":
        if not path.is_file():
            raise SceneError(f"scene file {path} does not exist")
    else:
        path = _FOLDER / f"{name}.toml"
        if os.sep in str(name) or not path.is_file():
            raise SceneError(f"unknown scene '{name}'; allowed: {', '.join(builtin_scenes())}, or a scene .toml file")
    try:
        source = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SceneError(f"scene file {path} is not valid TOML: {error}") from None
    source = override(source, settings)
    where = f"scene '{path.stem}'"
    refuse_unknown_keys(source, ("name", "description", "robot", *_SECTIONS), where, SceneError)
    for key in ("name", "description", "robot"):
        if not isinstance(source.get(key, ""), str):
            raise SceneError(f"{where}: '{key}' is not a text")
    parts: dict[str, Any] = {
        section: from_table(kind, source.get(section, {}), f"{where}: [{section}]")
        for section, kind in (_SECTIONS | _terrain_kind(source)).items()
    }
    return Scene(
        name=source.get("name", path.stem),
        description=source.get("description", ""),
        robot=robot or source.get("robot", "h1"),
        **parts,
    )
