"""File contents and versions that sweep rows depend on."""

import re
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from pathlib import Path

from plantar.common.files.input_file import is_file, open_input, sha256_of
from plantar.common.files.structured_text import read_toml
from plantar.common.sides import SIDES
from plantar.common.version import VERSION
from plantar.errors import RobotError, SceneError
from plantar.robots import load_robot
from plantar.sim.run.scene import scene_file

_NAMED = re.compile(rb"""\b(?:file|filename)\s*=\s*["']([^"']+)["']""")
_FOLDERS = re.compile(rb"""\b(?:meshdir|texturedir|assetdir)\s*=\s*["']([^"']+)["']""")


def inputs_of(scene: str, robot: str) -> dict[str, str]:
    """Returns library versions, and SHA-256 of all files that a `scene` with a `robot` reads.

    Example:
        >>> sorted(inputs_of("flat", "h1"))[:3]
        ['layout layout_left.json', 'layout layout_right.json', 'mujoco']
    """
    path = scene_file(scene)
    found = {"plantar": VERSION, "mujoco": version("mujoco")}
    found[f"scene file {path.name}"] = sha256_of(path, SceneError)
    companion = "experiment" in read_toml(path, SceneError, f"scene file {path}")
    files = _files_of_machine(robot) if companion else _files_of(robot)
    return found | {label: sha256_of(file, RobotError) for label, file in files}


def changes(before: Mapping[str, str], now: Mapping[str, str]) -> str:
    """Returns in words how inputs differ from `before` to `now`, or empty.

    Example:
        >>> changes({"plantar": "1.0", "layout a": "9f"}, {"plantar": "1.1", "layout a": "e0"})
        'plantar was 1.0 and is 1.1, layout a has changed'
    """
    found = []
    for label in [*before, *(label for label in now if label not in before)]:
        old = before.get(label)
        new = now.get(label)
        if old == new:
            continue
        if new is None or old is None:
            found.append(f"{label} is {'gone' if new is None else 'new'}")
        else:
            found.append(
                f"{label} was {old} and is {new}" if label in ("plantar", "mujoco") else f"{label} has changed"
            )
    return ", ".join(found)


def _files_of(robot: str) -> Iterator[tuple[str, Path]]:
    loaded = load_robot(robot)
    yield f"robot file {loaded.path.name}", loaded.path
    layout = read_toml(loaded.path, RobotError, str(loaded.path))["shoe"]["layout"]
    for side in SIDES:
        name = layout.replace("{side}", side)
        yield f"layout {name}", loaded.path.parent / name
    if loaded.model_file is not None:
        yield from _files_of_model(loaded.model_file)


def _files_of_machine(machine: str) -> Iterator[tuple[str, Path]]:
    from plantar.sim.companion.machine import load_machine  # MuJoCo, which a walk's sweep does not need here

    loaded = load_machine(machine)
    yield f"machine file {loaded.path.name}", loaded.path
    yield from _files_of_model(loaded.model_file)


def _files_of_model(model: Path) -> Iterator[tuple[str, Path]]:
    yield f"model {model.name}", model
    for name, file in _named_by(model).items():
        yield f"model file {name}", file


def _named_by(model: Path) -> dict[str, Path]:
    found: dict[str, Path] = {}
    folders = [model.parent]
    waiting = [model]
    while waiting:
        file = waiting.pop()
        with open_input(file, RobotError) as stream:
            text = stream.read()
        folders += [model.parent / _text(name) for name in _FOLDERS.findall(text)]
        for name in dict.fromkeys(map(_text, _NAMED.findall(text))):
            relative = re.sub(r"^(?:package|file)://[^/]*/", "", name)
            for path in (folder / relative for folder in (file.parent, *folders)):
                if name not in found and path != model and is_file(path):
                    found[name] = path
                    if path.suffix.lower() in (".xml", ".urdf"):
                        waiting.append(path)
    return found


def _text(name: bytes) -> str:
    return name.decode(errors="replace")
