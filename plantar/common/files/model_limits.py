"""Limits of a robot's model (MJCF, URDF), checked in its text."""

import math
import os
import re
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from plantar.common.files.input_file import is_text, name_in_text
from plantar.errors import PlantarError

MOST_PARTS = 2000
"""Most shapes, and most bodies: MuJoCo's reader takes a time that grows with their square."""

_KINDS = dict.fromkeys(("geom", "visual", "collision", "site"), "shapes") | dict.fromkeys(("body", "link"), "bodies")
# Largest number in an attribute of an element; other attributes named n... of "size" may be as large as _MOST_USER.
_MOST_OF = {
    ("hfield", "nrow"): 2000,
    ("hfield", "ncol"): 2000,
    ("texture", "width"): 8192,
    ("texture", "height"): 8192 * 6,
    ("numeric", "size"): 10_000,
    ("mesh", "params"): 256,
    ("size", "nconmax"): 100_000,
    ("size", "njmax"): 100_000,
    ("size", "nkey"): 10_000,
    ("size", "nuserdata"): 10_000_000,  # held once, 80 MB; other n... of "size" are held by each part
    ("size", "nstack"): 100_000_000,
    ("composite", "count"): 200,
    ("flexcomp", "count"): 100,
    ("flexcomp", "cellcount"): 100,
}
_MOST_USER = 1000
_MOST_MEMORY = 1e9
_UNITS = {"": 1.0, "K": 2.0**10, "M": 2.0**20, "G": 2.0**30}


def check_model_size(root: Element, error: type[PlantarError], where: str) -> None:
    """Refuse models with more parts than any robot, replicas counted, or too much table memory.

    Raises `error`, its message beginning with `where`; `root` is the outermost element, includes in place.

    Example:
        >>> from plantar.common.files.xml_file import parse_xml
        >>> text = b"<mujoco><asset><hfield nrow='60000' ncol='60000'/></asset></mujoco>"
        >>> check_model_size(parse_xml(text, PlantarError, "a.xml"), PlantarError, "a.xml")
        Traceback (most recent call last):
        plantar.errors.PlantarError: a.xml: <hfield>: nrow is '60000'; allowed: up to 2000
    """
    counts = dict.fromkeys(("shapes", "bodies"), 0.0)
    left = [(root, 1.0)]
    while left:
        element, times = left.pop()
        for key, text in element.attrib.items():
            _check_number(str(element.tag), key, text, error, where)
        if element.tag in _KINDS:
            counts[_KINDS[str(element.tag)]] += times
        if element.tag == "replicate":
            times *= max(0.0, _numbers(element.get("count", "1"))[0])
        left += [(child, times) for child in element]
    for what, count in counts.items():
        if count > MOST_PARTS:
            raise error(f"{where}: has {count:.0f} {what}; allowed: up to {MOST_PARTS} of a robot's model")


def _check_number(tag: str, key: str, text: str, error: type[PlantarError], where: str) -> None:
    most = _MOST_OF.get((tag, key), _MOST_USER if tag == "size" and key.startswith("n") else None)
    if tag == "size" and key == "memory":
        match = re.fullmatch(r"\s*(\d+)\s*([A-Za-z]?)\s*", text)
        if match and float(match[1]) * _UNITS.get(match[2].upper(), math.inf) > _MOST_MEMORY:
            raise error(f"{where}: <size>: memory is '{text[:40]}'; allowed: up to {_MOST_MEMORY / 1e9:g} GB")
    elif most is not None and max(_numbers(text)) > most:
        raise error(f"{where}: <{tag}>: {key} is '{text[:40]}'; allowed: up to {most}")


def _numbers(text: str) -> list[float]:
    """Attribute's numbers; 0 for others, which MuJoCo reports."""
    out = [0.0]
    for word in text.split():
        try:
            out.append(float(word))
        except ValueError:
            continue
    return out[1:] or out


def quiet_mujoco() -> Any:
    """Returns MuJoCo, whose warnings are not printed and put into MUJOCO_LOG.TXT; a caller's handler keeps them."""
    import mujoco

    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(lambda text: None)
    return mujoco


def spec_of_file(path: str | os.PathLike[str]) -> Any:
    """MuJoCo's editable model of an MJCF or URDF file.

    MuJoCo reads MJCF only under the name .xml; under another one, such as .mjcf, or one with a backslash, which it
    takes for the end of a folder, its text is read in its folder. PlantarError for a name that is not UTF-8.
    """
    kind = quiet_mujoco().MjSpec
    file = Path(path)
    name_in_text(file, PlantarError, "its name")
    if file.suffix.lower() in (".xml", ".urdf") and "\\" not in file.name:
        return kind.from_file(str(file))
    others = [p for pattern in ("*.xml", "*.mjcf") for p in file.parent.glob(pattern) if p.is_file() and p != file]
    beside = {p.name: p.read_bytes() for p in others if is_text(p.name)}  # what it may include
    spec = kind.from_string(file.read_text(encoding="utf-8"), include=beside)
    spec.modelfiledir = str(file.parent)
    return spec


def parsed_in_trial(path: str) -> dict[str, int]:
    """Let MuJoCo read a model, for `confined`; returns its body count, 0 if refused."""
    try:
        return {"bodies": len(spec_of_file(path).bodies)}
    except Exception:  # MuJoCo raises ValueError, OSError and its own
        return {"bodies": 0}
