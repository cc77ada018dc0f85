"""Body of a sensor cell as stated by its maker or a TOML file. In mm.

*Tiles* have a rubber head that spreads over the ribs. *Films* (with an active area, or round) lie at a pocket's
ceiling, pressed by a land of the pad. A *sheet* has rows and columns of electrodes; a cell lies around a crossing.
"""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal

from plantar.common.files.structured_text import packaged_files, read_toml
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import InputError
from plantar.shoes.parameters import check_dimensions, checked, choice, number, text
from plantar.shoes.parameters import length as mm

# How a cell is pressed: by its own head, by a land of the pad, or as a part of one sheet
Kind = Literal["tile", "film", "sheet"]

_BOTH = (("tail_length", "tail_width"), ("active_length", "active_width"), ("connector_length", "connector_height"))

SHAPES = ("hex", "square", "rectangle", "round", "sheet")  # what a cell's body is

# How cells are read: each by a divider of its own, by a bridge amplifier of its own, on rows and columns, or as their
# maker does, who states no wiring
CIRCUITS = ("own", "divider", "bridge", "matrix")

_ALL = (
    *("name", "about", "maker", "part", "data_sheet", "source", "shape", "pitch_x", "pitch_y"),
    *("thickness", "stiffness", "rated_load", "threshold", "play", "bend_radius"),
    *("circuit", "gain_scatter", "hysteresis", "drift", "crosstalk", "rise_time"),
)
_LEADS = ("leads", "lead_diameter", "lead_colours", "count")
_LEAST_LEADS = {"divider": 2, "bridge": 4}
_TAIL = ("tail_length", "tail_width", "connector_length", "connector_height")
# The keys that a cell's TOML may have, by its shape
KEYS: Mapping[str, tuple[str, ...]] = {
    "hex": tuple(k for k in (*_ALL, "size", "active", *_LEADS) if k != "pitch_y"),
    "square": (*_ALL, "size", "active", "lattice", *_LEADS, *_TAIL),
    "rectangle": (*_ALL, "length", "width", "active_length", "active_width", "lattice", *_LEADS, *_TAIL),
    "round": (*_ALL, "size", "active", "lattice", *_LEADS, *_TAIL),
    "sheet": (*_ALL, "lattice", "line_width", "edge", "tail_pitch"),
}


@dataclass(frozen=True)
class Cell:
    """Sensor cell kind. Lengths in mm, forces in N; 0 means unset, as texts describe.

    Example:
        >>> fsr = Cell(shape="round", size=18.28, active=12.7, thickness=0.46, tail_length=6.7, tail_width=8.0)
        >>> fsr.kind, round(fsr.active_area, 1)
        ('film', 126.7)
    """

    shape: str = choice("square", SHAPES, "of the body; of a sheet it is the sole's outline")
    name: str = text("", "name in the files; left out: the TOML file's")
    about: str = text("", "what it is, in a line")
    maker: str = text("", "who makes or sells it; left out: no shop does")
    part: str = text("", "part number to order")
    data_sheet: str = text("", "address of its data sheet or product page")
    source: str = text("", "where the figures are from")
    size: float = mm(0.0, 4.0, 120.0, "body across: flat to flat, side or diameter")
    length: float = mm(0.0, 4.0, 120.0, "body of a rectangle, along the rows")
    width: float = mm(0.0, 4.0, 120.0, "body of a rectangle, across the rows")
    active: float = mm(
        0.0, 2.0, 120.0, "active part, measured as size; left out: up to the next cell, or all of a round body"
    )
    active_length: float = mm(0.0, 2.0, 120.0, "of a rectangle, as active")
    active_width: float = mm(0.0, 2.0, 120.0, "of a rectangle, as active")
    pitch_x: float = mm(0.0, 2.0, 200.0, "from centre to centre within a row; left out: as near as the ribs allow")
    pitch_y: float = mm(0.0, 2.0, 200.0, "from row to row; left out: as near as the ribs allow")
    count: float = number(
        0.0, 1.0, 12.0, "cells", "of a foot, as far apart as the sole allows; left out: as many as fit"
    )
    lattice: str = choice(
        "auto", ("auto", "square", "hex"), "hex: every other row is shifted by half; auto: of round ones"
    )
    thickness: float = mm(0.0, 0.1, 15.0, "of the body; left out: rubber as high as protrusion and pocket")
    stiffness: float = number(0.0, 1.0, 1e7, "N/mm", "of the body below its active area; left out: it does not yield")
    rated_load: float = number(785.0, 0.5, 1e5, "N", "most that a cell measures")
    threshold: float = number(1.471, 0.0, 1e3, "N", "from which on it counts as pressed")
    play: float = mm(0.2, 0.0, 2.0, "gap between the body and its pocket")
    leads: float = number(0.0, 0.0, 40.0, "leads", "each cell's own to the heel; 0: a cable from cell to cell")
    lead_diameter: float = mm(0.6, 0.1, 3.0, "of a lead with its insulation")
    lead_colours: str = text("", "what each lead is and its colour, as E+ red, E- black, A+ green, A- white")
    circuit: str = choice("own", CIRCUITS, "how it is read; own: as its maker does")
    gain_scatter: float = number(0.0, 0.0, 1.0, "share", "standard deviation of the gain from cell to cell")
    hysteresis: float = number(0.0, 0.0, 1.0, "share", "by which a reading is larger while the load falls")
    drift: float = number(0.0, 0.0, 1.0, "share", "by which a reading under load changes a decade of time")
    crosstalk: float = number(0.0, 0.0, 0.5, "share", "of a cell's reading that its neighbours have together")
    rise_time: float = number(0.0, 0.0, 10.0, "s", "of its response")
    tail_length: float = mm(0.0, 1.0, 120.0, "straight tail beyond the body, along the rows")
    tail_width: float = mm(0.0, 1.0, 60.0, "of the tail")
    connector_length: float = mm(0.0, 1.0, 60.0, "connector at the tail's end and as wide, along the tail")
    connector_height: float = mm(0.0, 0.2, 15.0, "of the connector, below the pocket's ceiling")
    bend_radius: float = mm(0.0, 0.2, 40.0, "smallest inner radius of the cable, lead or sheet's tail up the heel")
    line_width: float = mm(0.0, 0.2, 50.0, "electrodes of a sheet")
    edge: float = mm(1.0, 0.0, 20.0, "sheet beyond its outermost electrodes")
    tail_pitch: float = mm(0.5, 0.1, 5.0, "of the lines in a sheet's tail, a line for each row and column and one more")

    def __post_init__(self) -> None:
        given = {f.name for f in fields(self) if getattr(self, f.name) != f.default} - {"shape"}
        if self.shape not in SHAPES:
            raise InputError(f"cell key shape is {self.shape!r}; allowed: {', '.join(SHAPES)}")
        foreign = sorted(given - set(KEYS[self.shape]))
        if foreign:
            raise InputError(
                f"cell key {foreign[0]} is not of a {self.shape} cell; allowed: {', '.join(KEYS[self.shape])}"
            )
        check_dimensions(self, "cell key", sorted(given))  # what is left out is 0, below the range of what is given
        self._check_needs()
        self._check_sizes()

    def _check_needs(self) -> None:
        needs = {"rectangle": ("length", "width"), "sheet": ("pitch_x", "pitch_y", "line_width", "thickness")}
        for name in needs.get(self.shape, ("size",)):
            if not getattr(self, name):
                raise InputError(
                    f"cell of shape {self.shape} has no {name}; it needs: {', '.join(needs.get(self.shape, ('size',)))}"
                )
        for one, other in _BOTH:
            if bool(getattr(self, one)) != bool(getattr(self, other)):
                raise InputError(f"cell has one of {one} and {other}; give both or none")
        if self.tail_length and self.kind == "tile":
            raise InputError("cell has a tail and no active area: a head that spreads over the tail would press on it")
        if self.kind == "film" and not self.thickness:
            raise InputError("cell with an active area has no thickness; a land of the pad presses on its face")
        if self.stiffness and not self.thickness:
            raise InputError("cell key stiffness is that of a body with a thickness; give both, or none for rubber")
        for name, most in (("leads", 40), ("count", 12)):
            if getattr(self, name) != round(getattr(self, name)):
                raise InputError(f"cell key {name} is {getattr(self, name):g}; allowed: a whole number, 0 to {most}")
        if (self.circuit == "matrix") != (self.shape == "sheet") and self.circuit != "own":
            raise InputError(
                f"cell key circuit is '{self.circuit}' of a {self.shape} cell; allowed: matrix of a sheet, divider or "
                "bridge of other cells"
            )
        if self.circuit in _LEAST_LEADS and self.leads < _LEAST_LEADS[self.circuit]:
            raise InputError(
                f"cell key leads is {self.leads:g}; allowed: {_LEAST_LEADS[self.circuit]} or more with circuit "
                f"'{self.circuit}'"
            )

    def _check_sizes(self) -> None:
        pairs = [
            ("active", "size"),
            ("active_length", "length"),
            ("active_width", "width"),
            ("threshold", "rated_load"),
            ("connector_length", "tail_length"),
        ]
        pairs += [("line_width", "pitch_x"), ("line_width", "pitch_y")] if self.shape == "sheet" else []
        pairs += [("tail_width", "size")] if self.size else [("tail_width", "width")] if self.width else []
        for small, large in pairs:
            if getattr(self, small) > getattr(self, large):
                unit = type(self).__dataclass_fields__[small].metadata["unit"]
                raise InputError(
                    f"cell key {small} is {getattr(self, small):g} {unit}; allowed: {large} = "
                    f"{getattr(self, large):g} {unit} or less"
                )

    @property
    def label(self) -> str:
        """Name, or shape without one."""
        return self.name or self.shape

    @property
    def kind(self) -> Kind:
        if self.shape == "sheet":
            return "sheet"
        return "film" if self.active or self.active_length or self.shape == "round" else "tile"

    @property
    def body(self) -> tuple[float, float]:
        """Body extent along and across rows, without tail; of a sheet, a crossing's."""
        if self.shape == "rectangle":
            return self.length, self.width
        if self.shape == "sheet":
            return self.line_width, self.line_width
        return self.size, self.size * 2.0 / math.sqrt(3.0) if self.shape == "hex" else self.size

    @property
    def active_extent(self) -> tuple[float, float]:
        """Film's active extent along and across rows."""
        if self.shape == "rectangle":
            return self.active_length, self.active_width
        across = self.active or self.size
        return across, across * 2.0 / math.sqrt(3.0) if self.shape == "hex" else across

    @property
    def active_area(self) -> float:
        along, across = self.active_extent
        return {"round": 0.25 * math.pi, "hex": 0.75}.get(self.shape, 1.0) * along * across

    def as_dict(self) -> dict[str, float | str]:
        """Values that are set, by its shape's keys, as in TOML."""
        every = {f.name: f.default for f in fields(self) if f.name in KEYS[self.shape]}
        return {k: getattr(self, k) for k, d in every.items() if d not in (0.0, "") or getattr(self, k) != d}

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any], where: str) -> "Cell":
        """Cell from a TOML table."""
        if values.get("shape") not in SHAPES:
            given = f"is {values['shape']!r}" if "shape" in values else "is missing"
            raise InputError(f"{where}: cell key shape {given}; allowed: {', '.join(SHAPES)}")
        refuse_unknown_keys(values, KEYS[values["shape"]], where, note=f" of a {values['shape']} cell")
        try:
            for name in values:
                checked(cls, name, values[name], "cell key")
            return cls(**values)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None

    @classmethod
    def table(cls) -> list[dict[str, Any]]:
        """Each key as a row: name, default, low, high, unit (or choices), text, shapes."""
        return [
            {"name": f.name, "default": f.default, "shapes": [s for s in SHAPES if f.name in KEYS[s]], **f.metadata}
            for f in fields(cls)
        ]


_NAME_MOST = 40  # letters


def built_in_cells() -> dict[str, Path]:
    """Built-in cells' files by name.

    Example:
        >>> sorted(built_in_cells())
        ['fsr_402', 'fsr_402_short', 'fsr_406', 'fx29_100', 'fx29_200', 'fx29_25', 'hex', 'velostat']
    """
    return {path.stem: path for path in packaged_files("plantar.shoes", "cells/*.toml")}


def read_cell(name: str | os.PathLike[str]) -> Cell:
    """Built-in cell by name, or a TOML file's, named as that file by default.

    Raises:
        InputError: If unknown, unreadable or unfit.

    Example:
        >>> read_cell("fsr_402").part
        '30-81794 (FSR 402)'
    """
    known = built_in_cells()
    path = known.get(str(name), Path(name))
    if path.suffix.lower() != ".toml":
        raise InputError(f"no cell '{name}'; allowed: {', '.join(known)}, or a .toml file that describes one")
    where = f"cell file {path}"
    cell = Cell.from_mapping(read_toml(path, InputError, where), where)
    return cell if cell.name else replace(cell, name=path.stem[:_NAME_MOST])
