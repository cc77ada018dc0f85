"""A scene of the companion: a TOML that names an experiment and a machine; no simulator is needed to read it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from plantar.errors import SceneError
from plantar.settings.overrides import owner_of, split_setting, value_of
from plantar.settings.schema import Settings
from plantar.settings.unknown_keys import refuse_unknown_keys
from plantar.sim.body_skin.sensing import SkinSensing
from plantar.sim.companion.experiment import CompanionControl, Experiment, experiment_class
from plantar.sim.companion.lidar import LidarSettings
from plantar.sim.papers.preset import with_paper

__all__ = ["CompanionScene", "companion_scene", "companion_tables"]


@dataclass(frozen=True)
class CompanionScene:
    """A scene of the companion.

    Attributes:
        description: One line.
        robot: Name or TOML file of the machine.
        kind: Name of the experiment.
        skin: What the skin is made of and how it measures.
        experiment: Settings of the experiment.
        control: Gains and switches of the controller.
        lidar: Distance sensors of the base, or None.
    """

    name: str
    description: str
    robot: str
    kind: str
    skin: SkinSensing
    experiment: Settings
    control: CompanionControl
    lidar: LidarSettings | None

    def setting_name(self, key: str) -> str:
        """Full name "table.name" of a setting's key, or "robot".

        Raises:
            SceneError: If the scene has no such key.
        """
        if key.strip() in ("robot", "machine"):
            return "robot"
        kinds = {section: kind.names() for section, kind in companion_tables(self.kind).items()}
        return ".".join(owner_of(key.strip(), "", kinds))

    @property
    def experiment_type(self) -> type[Experiment]:
        """The experiment's class."""
        return experiment_class(self.kind)


def companion_tables(kind: str) -> dict[str, type[Settings]]:
    """Settings class of each table of a scene with an experiment, by the table's name.

    Raises:
        SceneError: If there is no such experiment.
    """
    found = experiment_class(kind)
    tables: dict[str, type[Settings]] = {
        "skin": SkinSensing,
        "experiment": found.settings_type,
        "control": found.control_type,
    }
    return tables | ({"lidar": LidarSettings} if found.uses_lidar else {})


def companion_scene(
    source: Mapping[str, Any], path: Path, settings: Sequence[str] = (), machine: str | None = None
) -> CompanionScene:
    """Make a scene of a TOML file's content.

    Args:
        source: The content; its `experiment` is a name, or a table whose `kind` is the name.
        path: The file, for names and messages.
        settings: `key=value` settings that override the file's.
        machine: Machine to use instead of the file's.

    Returns:
        The scene.

    Raises:
        SceneError: If a field is not valid.
    """
    where = f"scene '{path.stem}'"
    result: dict[str, Any] = {k: dict(v) if isinstance(v, Mapping) else v for k, v in source.items()}
    experiment = result.pop("experiment")
    table = experiment if isinstance(experiment, dict) else {}
    kind = table.pop("kind", None) if isinstance(experiment, dict) else experiment
    if not isinstance(kind, str):
        raise SceneError(f"{where}: 'experiment' is {kind!r}; allowed: a name, or a table with kind = its name")
    result["experiment"] = table
    paper, settings = with_paper(settings, path.stem, machine or str(result.get("machine", "")))
    kinds = companion_tables(kind)
    for setting in settings:
        key, text = split_setting(setting)
        if key in ("robot", "machine"):
            result["machine"] = text
            continue
        owner, name = owner_of(key, text, {section: k.names() for section, k in kinds.items()})
        held = result.setdefault(owner, {})
        if not isinstance(held, dict):
            raise SceneError(f"scene section '{owner}' is not a table")
        held[name] = value_of(text)
    refuse_unknown_keys(result, ("name", "description", "machine", *kinds), where, SceneError)
    for key in ("name", "description", "machine"):
        if not isinstance(result.get(key, ""), str):
            raise SceneError(f"{where}: '{key}' is not a text")
    if not (machine or result.get("machine")):
        raise SceneError(f'{where} names no machine; it needs machine = "..."')
    parts: dict[str, Any] = {
        name: own.from_table(result.get(name, {}), f"{where}: [{name}]", SceneError) for name, own in kinds.items()
    }
    return CompanionScene(
        name=result.get("name", path.stem) + (f" as {paper}" if paper else ""),
        description=result.get("description", ""),
        robot=machine or result["machine"],
        kind=kind,
        **{"lidar": None, **parts},
    )
