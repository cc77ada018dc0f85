"""Masks: which parts of a foot are measured by themselves.

Seven automatic regions, ten by anatomy, or polygons in foot coordinates from a file: u from heel (0) to toes (1), v
from lateral (0) to medial (1) edge of the sole, or on a platform of the footprint.
"""

import os
import re
from dataclasses import dataclass
from typing import Any, cast

from plantar.common.files.structured_text import read_json
from plantar.common.files.text_table import read_text_table
from plantar.errors import InputError
from plantar.formats.text import number

_FARTHEST = 2.0  # Largest distance of a corner from the middle of the foot, in shares of its length or width
_MOST = 60  # Masks of a file
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_ -]{0,39}")

SEVEN: tuple[tuple[str, str], ...] = (
    ("heel", "Heel"),
    ("midfoot", "Midfoot"),
    ("forefoot_medial", "Forefoot, medial"),
    ("forefoot_central", "Forefoot, central"),
    ("forefoot_lateral", "Forefoot, lateral"),
    ("hallux", "Hallux"),
    ("toes", "Toes 2 to 5"),
)
"""Names and titles of the automatic regions, from heel to toes."""

TEN: tuple[tuple[str, str], ...] = (
    ("heel_medial", "Heel, medial"),
    ("heel_lateral", "Heel, lateral"),
    ("midfoot", "Midfoot"),
    ("metatarsal_1", "Metatarsal 1"),
    ("metatarsal_2", "Metatarsal 2"),
    ("metatarsal_3", "Metatarsal 3"),
    ("metatarsal_4", "Metatarsal 4"),
    ("metatarsal_5", "Metatarsal 5"),
    ("hallux", "Hallux"),
    ("toes", "Toes 2 to 5"),
)
"""Names and titles of the ten regions by anatomy, from heel to toes."""

Polygon = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Masks:
    """Regions that are measured.

    `kind`: "seven", "ten" or "polygons"; `names`: names and titles of the regions; `polygons`: corners (n, 2) in foot
    coordinates of each, for polygons alone. Polygons may overlap.
    """

    kind: str
    names: tuple[tuple[str, str], ...]
    polygons: tuple[Polygon, ...] = ()

    @property
    def titles(self) -> dict[str, str]:
        """Titles by name."""
        return dict(self.names)


# What `--masks seven` and `--masks ten` measure.
SEVEN_MASKS = Masks("seven", SEVEN)
TEN_MASKS = Masks("ten", TEN)


def masks_of(text: str | None) -> Masks:
    """Masks of a command's word: None or "seven", "ten", or the path of a file of `read_masks`.

    Example:
        >>> masks_of("ten").names[-2]
        ('hallux', 'Hallux')
    """
    if text is None or text == "seven":
        return SEVEN_MASKS
    if text == "ten":
        return TEN_MASKS
    if not os.path.exists(text):
        raise InputError(f"--masks {text}: no such file; allowed: seven, ten, or a file of polygons")
    return read_masks(text)


def read_masks(path: str | os.PathLike[str]) -> Masks:
    """Read polygons in foot coordinates: a JSON object of corner lists by name, or a table of mask, u and v.

    A table (CSV or TSV) has a row for each corner, in order around its mask.

    Raises:
        InputError: If the file is unreadable, or a mask is no polygon.
    """
    if os.fspath(path).lower().endswith(".json"):
        held = read_json(path, InputError, os.fspath(path))
    else:
        held = _corners_of_table(path)
    if not isinstance(held, dict) or not held or len(held) > _MOST:
        raise InputError(f"{path}: allowed: an object of 1 to {_MOST} masks, each a list of corners [u, v]")
    return masks_of_polygons({str(name): corners for name, corners in held.items()}, os.fspath(path))


def _corners_of_table(path: str | os.PathLike[str]) -> dict[str, list[tuple[float | None, float | None]]]:
    table = read_text_table(path, InputError)
    found = [table.column(*names) for names in (("mask", "region", "name"), ("u", "length"), ("v", "width"))]
    if None in found:
        raise InputError(f"{path}: a table of masks has the columns mask, u and v; this one {', '.join(table.names)}")
    name, u, v = cast(list[int], found)
    held: dict[str, list[tuple[float | None, float | None]]] = {}
    for line, row in table.rows:
        if len(row) <= max(name, u, v) or number(row[u]) is None or number(row[v]) is None:
            raise InputError(f"{path}, line {line}: allowed: a mask's name, and numbers u and v")
        held.setdefault(row[name].strip(), []).append((number(row[u]), number(row[v])))
    return held


def masks_of_polygons(polygons: Any, where: str = "masks") -> Masks:
    """Masks of corners (n, 2) by name; an InputError whose message begins with `where` if one is no polygon.

    Example:
        >>> masks_of_polygons({"hallux": [[0.85, 0.5], [1, 0.5], [1, 1], [0.85, 1]]}).names
        (('hallux', 'Hallux'),)
    """
    from shapely import Polygon as Ring

    rings: list[Polygon] = []
    names: list[tuple[str, str]] = []
    for name, corners in polygons.items():
        if not _NAME.fullmatch(name):
            raise InputError(f"{where}: mask {name!r}; allowed: a name of letters, digits, blanks, _ and -")
        try:
            ring = tuple((float(u), float(v)) for u, v in corners)
        except (TypeError, ValueError):
            raise InputError(f"{where}: mask {name}: allowed: corners [u, v], two numbers each") from None
        near = all(abs(value - 0.5) <= _FARTHEST for corner in ring for value in corner)
        if len(ring) < 3 or not near or not Ring(ring).is_valid:
            raise InputError(
                f"{where}: mask {name} crosses itself, has less than three corners, or some far from a foot; allowed: "
                "shares of its length and width, from heel (0) to toes (1) and from lateral (0) to medial (1)"
            )
        rings.append(ring)
        names.append((name.replace(" ", "_"), name.replace("_", " ").capitalize()))
    return Masks("polygons", tuple(names), tuple(rings))
