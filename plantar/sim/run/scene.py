"""A scene: a TOML of terrain, robot, gait, sensing and disturbances, read without a simulator."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from plantar.common.files.structured_text import packaged_files, read_toml
from plantar.common.settings.body_scale import BodyScale
from plantar.common.settings.overrides import put_settings, split_setting
from plantar.common.settings.schema import Settings, choice, number, switch, whole
from plantar.common.settings.unknown_keys import builtin_or_file, refuse_other_than_texts, refuse_unknown_keys
from plantar.errors import InputError, SceneError
from plantar.gait.controller_tables import CONTROLLER_TABLES, check_controller_table, controller_keys
from plantar.robots.walk import Control, Walk
from plantar.sim.arms.settings import ArmSettings
from plantar.sim.judging.criteria.criterion import Criterion
from plantar.sim.judging.criteria.kinds import outcome_of
from plantar.sim.model.contact_settings import Contact
from plantar.sim.papers.preset import with_paper
from plantar.sim.partner.settings import GuideSettings, PartnerSettings
from plantar.sim.plant.settings import Plant
from plantar.sim.sensing.settings import Sensing
from plantar.sim.terrain import Flat, Terrain, terrain_kinds


class Push(Settings):
    """Pushes on the base: in one or several steps, or while the robot stands.

    Attributes:
        dv: Velocity in m/s given to a free body; 0: no push.
        impulse: In N s instead of `dv`, the same for every robot; 0: by `dv`.
        duration: In s.
        by: A "force" on the torso, or "hands" on the upper body's skin (`sensing.body_skin`).
        direction: In the robot's frame; "angle" uses `angle`, "step" is along its step, with "seeded" the seed draws
            it.
        angle: In degrees from forward to the left, for `direction` "angle".
        step: Step in whose single support it comes; -1: drawn.
        phase: Share of single support at which it begins.
        cycle: Share of the stride from that single support's begin, instead of `phase`; -1: by `phase`. By hands only.
        with_swing: Whether a push to a side waits, at most one step, for a foot that swings to that side (no step
            catches more than 37 N s over the standing foot on h1, `benchmarks/capture_limit.py`). By hands only.
        repeat: Number of steps, from that one on, with a push each. By hands only.
        small: Share of the impulse of one more push some steps earlier; 0: none. By hands only.
        small_before: How many steps earlier `small` comes.
        count: Pushes on a standing robot; 0: once, in a step.
        interval: Time in s between such pushes.
        sideways: Strength to the side as a share of forward; an ellipse in between.
        height: In m above the torso's CoM; 0.6 is about the neck.
        place: Where hands push: `height`, CoM, hips or shoulders.
    """

    dv: float = number(0.0, "m/s", 0, 10)
    impulse: float = number(0.0, "N s", 0, 1000)
    duration: float = number(0.1, "s", 0.001, 10)
    by: str = choice("force", "hands")
    direction: str = choice("seeded", "forward", "backward", "left", "right", "angle", "step")
    angle: float = number(0.0, "deg", -360, 360)
    step: int = whole(-1, "step", -1, 100000)
    phase: float = number(0.5, "1", 0, 1)
    cycle: float = number(-1.0, "1", -1, 1)
    with_swing: bool = switch(False)
    repeat: int = whole(1, "steps", 1, 100000)
    small: float = number(0.0, "1", 0, 1)
    small_before: int = whole(4, "steps", 1, 1000)
    count: int = whole(0, "pushes", 0, 1000)
    interval: float = number(4.0, "s", 0.1, 60)
    sideways: float = number(1.0, "1", 0, 1)
    height: float = number(0.0, "m", -1, 1)
    place: str = choice("height", "com", "hip", "shoulder")

    @property
    def strength(self) -> float:
        """Impulse in N s, for the settings' body."""
        return self.impulse or self.dv * self.body.mass


SECTIONS: dict[str, type[Settings]] = {
    "terrain": Flat,  # or another of `terrain_kinds`, by its field `kind`
    "walk": Walk,
    "sensing": Sensing,
    "push": Push,
    "partner": PartnerSettings,
    "arm": ArmSettings,
    "guide": GuideSettings,
    "control": Control,
    "plant": Plant,
    "sole_contact": Contact,
}
"""Settings class of each table of a scene; `terrain` has the one of its kind."""

_LEAST = ("terrain", "walk")  # Sections of which a scene file has one at least: an empty or foreign file is no scene

_ALIASES: Mapping[str, str] = {
    "sideways": "walk.sideways",
    "t_ss": "walk.single_support",
    "t_ds": "walk.double_support",
    "noise": "sensing.force_noise",
    "delay": "sensing.delay_periods",
    "plant": "plant.draw",
}


@dataclass(frozen=True, repr=False)
class Scene:
    """A scene.

    `controller`: given controller settings by table and name (`plantar.gait.controller_tables`); `plant`: True
    differences from the controller's model; `partner`: mobile robot in front; `guide`: hand that leads by that arm;
    `outcome`: what the experiment shows, criteria by name (`plantar.sim.judging.criteria`).
    """

    name: str
    description: str
    robot: str
    terrain: Terrain
    walk: Walk
    sensing: Sensing
    push: Push
    control: Control
    controller: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    plant: Plant = field(default_factory=Plant)
    partner: PartnerSettings = field(default_factory=PartnerSettings)
    arm: ArmSettings = field(default_factory=ArmSettings)
    guide: GuideSettings = field(default_factory=GuideSettings)
    sole_contact: Contact = field(default_factory=Contact)
    outcome: Mapping[str, Criterion] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"Scene({self.name!r} with {self.robot}: {self.description})"

    @property
    def proximity_range(self) -> float:
        return self.sensing.proximity_range

    def setting_name(self, key: str) -> str:
        """Full name of a setting's key, "section.key", or "robot".

        Example:
            >>> load_scene("flat").setting_name("t_ss")
            'walk.single_support'
        """
        full = _ALIASES.get(key.strip(), key.strip())
        if full == "robot":
            return full
        section, _, name = full.rpartition(".")
        for owner in (section,) if section else SECTIONS:
            if owner in SECTIONS and name in getattr(self, owner).names():
                return f"{owner}.{name}"
        owners = [s for s in CONTROLLER_TABLES if name in controller_keys(s) and section in ("", s)]
        if len(owners) == 1:
            return f"{owners[0]}.{name}"
        raise SceneError(f"scene '{self.name}' has no setting '{key}'")

    def for_body(self, body: BodyScale) -> "Scene":
        """The scene with body shares as numbers."""
        sections: dict[str, Any] = {}
        for name in SECTIONS:
            try:
                sections[name] = getattr(self, name).for_body(body)
            except InputError as error:
                words = str(error).removeprefix("setting ")
                raise SceneError(f"scene '{self.name}': [{name}] {words}, with robot '{self.robot}'") from None
        outcome = {name: criterion.for_body(body) for name, criterion in self.outcome.items()}
        return replace(self, outcome=outcome, **sections)


def builtin_scenes() -> tuple[str, ...]:
    """Names of the built-in scenes."""
    return tuple(sorted(_builtin()))


def _builtin() -> dict[str, Path]:
    return {path.stem: path for path in packaged_files("plantar.sim", "scenes/*.toml")}


def override(source: Mapping[str, Any], settings: Sequence[str]) -> dict[str, Any]:
    """Apply `key=value` settings to a scene's tables.

    Args:
        settings: "section.key=value" or, for a unique key, "key=value"; values are TOML, bare words texts. A scene's
            own key comes before a controller's.

    Returns:
        A changed copy.

    Example:
        >>> override({"walk": {"steps": 20}}, ["steps=4", "control.feedback=false"])
        {'walk': {'steps': 4}, 'control': {'feedback': False}}
    """
    result = {k: dict(v) if isinstance(v, Mapping) else v for k, v in source.items()}
    if isinstance(result.get("plant"), str):
        result["plant"] = {"draw": result["plant"]}
    pairs: list[tuple[str, str]] = []
    for setting in settings:
        key, text = split_setting(setting)
        key = _ALIASES.get(key, key)
        if key in ("kind", "terrain.kind"):  # first: it decides which other keys there are
            terrain = result.setdefault("terrain", {})
            if isinstance(terrain, dict):
                terrain["kind"] = text
        else:
            pairs.append((key, text))
    keys = {name: kind.names() for name, kind in (SECTIONS | _terrain_kind(result)).items()}
    parts = {name: controller_keys(name) for name in CONTROLLER_TABLES}
    put_settings(result, pairs, {"robot": "robot", "outcome": "outcome"}, keys, parts)
    return result


def _terrain_kind(source: Mapping[str, Any]) -> dict[str, type[Settings]]:
    table = source.get("terrain", {})
    kind = table.get("kind", "flat") if isinstance(table, Mapping) else "flat"
    if not isinstance(kind, str) or kind not in terrain_kinds():
        raise SceneError(f"terrain.kind is {kind!r}; allowed: {', '.join(terrain_kinds())}")
    return {"terrain": terrain_kinds()[kind]}


def scene_file(name: str | os.PathLike[str]) -> Path:
    """A scene's file, by built-in name (`builtin_scenes()`) or path.

    Example:
        >>> scene_file("flat").name
        'flat.toml'
    """
    return builtin_or_file(name, "scene", _builtin(), SceneError)


def load_scene(name: str | os.PathLike[str], settings: Sequence[str] = (), robot: str | None = None) -> Scene:
    """Returns a scene, by built-in name (`builtin_scenes()`) or TOML path.

    `key=value` `settings` and `robot` replace the file's. A SceneError if name or field is invalid.

    Example:
        >>> load_scene("flat", ["steps=4"]).walk.steps
        4
    """
    path = scene_file(name)
    return scene_of(read_toml(path, SceneError, f"scene file {path}"), path, settings, robot)


def scene_of(source: Mapping[str, Any], path: Path, settings: Sequence[str] = (), robot: str | None = None) -> Scene:
    """Returns the scene of TOML content `source`; `path` is for messages, `settings` and `robot` as of `load_scene`."""
    given = set(source)
    paper, settings = with_paper(settings, path.stem, robot or str(source.get("robot", "h1")))
    source = override(source, settings)
    where = f"scene '{path.stem}'"
    known = ("name", "description", "robot", "outcome", *SECTIONS, *CONTROLLER_TABLES)
    refuse_unknown_keys(source, known, where, SceneError)
    if given.isdisjoint(_LEAST):
        raise SceneError(f"scene file {path} names neither ground nor gait; it needs [terrain] or [walk], or both")
    refuse_other_than_texts(source, ("name", "description", "robot"), where, SceneError)
    parts: dict[str, Any] = {
        section: kind.from_table(source.get(section, {}), f"{where}: [{section}]", SceneError)
        for section, kind in (SECTIONS | _terrain_kind(source)).items()
    }
    return Scene(
        name=source.get("name", path.stem) + (f" as {paper}" if paper else ""),
        description=source.get("description", ""),
        robot=robot or source.get("robot", "h1"),
        controller={
            name: check_controller_table(name, source[name], f"{where}: [{name}]", SceneError)
            for name in CONTROLLER_TABLES
            if name in source
        },
        outcome=outcome_of(source.get("outcome", {}), where),
        **parts,
    )
