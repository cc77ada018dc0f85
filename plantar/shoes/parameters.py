"""Every dimension of the shoe: a named parameter with default and range."""

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from plantar.common.files.structured_text import read_json, read_toml
from plantar.errors import InputError
from plantar.shoes.materials import MATERIALS, PROCESSES, Material, Process


def length(default: float, low: float, high: float, meaning: str) -> Any:
    """Gives dataclass field for a length in mm: default, low and high limits, meaning."""
    return number(default, low, high, "mm", meaning)


def number(default: float, low: float, high: float, unit: str, meaning: str) -> Any:
    """Gives dataclass field for a number: default, low and high limits, unit ("-" for none), meaning."""
    return field(default=default, metadata={"low": low, "high": high, "unit": unit, "text": meaning})


def choice(default: str, choices: tuple[str, ...], meaning: str) -> Any:
    """Gives dataclass field for a choice: default, choices, meaning."""
    return field(default=default, metadata={"choices": choices, "text": meaning})


def text(default: str, meaning: str) -> Any:
    """Gives dataclass field for a one-line text: default, meaning."""
    return field(default=default, metadata={"text": meaning})


def checked(record: Any, name: str, value: Any, what: str) -> Any:
    """Gives value for the field of a name of a dataclass (record), numbers as floats; what is the word for fields in
    messages.
    """
    metadata = record.__dataclass_fields__[name].metadata
    if "choices" in metadata:
        if value not in metadata["choices"]:
            raise InputError(f"{what} {name} is {value!r}; allowed: {', '.join(metadata['choices'])}")
    elif "unit" in metadata:
        low, high, unit = (metadata[key] for key in ("low", "high", "unit"))
        good = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not (good and math.isfinite(value) and low <= value <= high):
            raise InputError(f"{what} {name} is {value!r} {unit}; allowed: {low:g} to {high:g} {unit}")
        return float(value)
    elif not isinstance(value, str) or not value.isprintable():
        raise InputError(f"{what} {name} is {value!r}; allowed: a text of one line")
    return value


def check_dimensions(record: Any, what: str, names: Iterable[str] | None = None) -> None:
    """Check fields, by names or all, of a frozen dataclass (record) being made, numbers as floats; what is the word for
    its fields.
    """
    for name in [f.name for f in fields(record)] if names is None else names:
        object.__setattr__(record, name, checked(record, name, getattr(record, name), what))


# How the shoe is held on the foot; auto takes clips where the foot has an edge to clip over, straps otherwise
RETENTIONS: tuple[str, ...] = ("auto", "clips", "straps", "screws", "none")


@dataclass(frozen=True)
class ShoeParameters:
    """Tactile shoe dimensions, from the ground up. In mm.

    Raises:
        InputError: For unfit or contradictory values.

    Example:
        >>> ShoeParameters(pad_thickness=3.0).thickness
        13.0
    """

    pad_thickness: float = length(2.0, 0.0, 10.0, "replaceable silicone pad under the taxels, its lower face the sole")
    taxel_protrusion: float = length(2.5, 0.0, 15.0, "how far the taxels stand out below the printed part")
    pad_relief: float = length(0.4, 0.0, 15.0, "gap between the pad's rim and the print; strengthen may raise it")
    pocket_depth: float = length(2.5, 0.4, 20.0, "pocket for the base of a taxel, from the printed lower face")
    floor: float = length(5.0, 1.0, 30.0, "plate between the pockets and the foot; strengthen may raise it")
    rib: float = length(2.4, 0.8, 8.0, "wall between two pockets, centred on the border of the cells")
    border: float = length(2.0, 0.5, 20.0, "sole beyond the outermost cells")
    scribe: float = length(0.4, 0.0, 1.5, "depth of the groove in the ribs that marks the border of the cells")
    port_width: float = length(
        6.0, 0.0, 20.0, "gap in a rib where the cable passes to the next taxel; 0: no ways for a cable at all"
    )
    clearance: float = length(0.5, 0.0, 5.0, "gap between foot and wall (printer tolerance)")
    rim_height: float = length(12.0, 2.0, 60.0, "wall above the face the foot stands on")
    rim_thickness: float = length(3.0, 0.8, 15.0, "wall around the foot; strengthen may raise it")
    lead_in: float = length(1.0, 0.0, 3.0, "bevel of the wall's upper inner edge")
    fillet: float = length(2.0, 0.0, 6.0, "radius between wall and plate and at the corners of lugs")
    overhang_max: float = length(10.0, 0.0, 40.0, "how far the sole may reach beyond the foot")
    reach_max: float = length(15.0, 0.0, 60.0, "how far lugs, clips and the board's holder may")
    strap_width: float = length(20.0, 6.0, 50.0, "strap; on a short foot at most a sixth of its length is used")
    strap_thickness: float = length(2.0, 0.5, 6.0, "strap, and the room left for it between lug and foot")
    clip_hook: float = length(1.5, 0.5, 4.0, "how far a clip reaches over the edge of the foot")
    clip_width: float = length(14.0, 6.0, 40.0, "arm of a clip")
    clip_thickness: float = length(2.5, 1.2, 6.0, "arm of a clip")
    clip_height_max: float = length(40.0, 10.0, 80.0, "highest edge of the foot that a clip reaches for")
    screw_diameter: float = length(4.0, 2.5, 6.0, "clamping screws through the wall, where retention is screws")
    channel_width: float = length(8.0, 2.0, 20.0, "cable channel from the patch to the exit at the heel")
    board_length: float = length(30.0, 0.0, 80.0, "connection board, upright behind the heel; 0 leaves its holder out")
    board_thickness: float = length(1.6, 0.8, 3.2, "connection board")
    board_gap: float = length(2.2, 0.5, 8.0, "room for components between wall and board")
    mark_height: float = length(9.0, 0.0, 30.0, "letters of the mark (side and name) in the floor; 0 leaves it out")
    mark_depth: float = length(0.6, 0.2, 2.0, "depth of the mark")
    wall_min: float = length(1.2, 0.4, 5.0, "thinnest wall the printer makes")
    bridge_max: float = length(30.0, 1.0, 400.0, "widest ceiling the printer bridges without support")
    bed_length: float = length(380.0, 50.0, 2000.0, "printer's room along its longer side")
    bed_width: float = length(284.0, 50.0, 2000.0, "printer's room along its shorter side")
    bed_height: float = length(380.0, 50.0, 2000.0, "printer's room upwards")
    sole_band: float = length(5.0, 0.5, 20.0, "height of the lowest part of the foot that is its sole")
    robot_mass: float = number(0.0, 0.0, 1000.0, "kg", "of the robot; 0 takes its file's, or estimates by the foot")
    load_factor: float = number(1.5, 0.5, 10.0, "-", "load case: times the robot's weight ...")
    load_share: float = number(1 / 3, 0.05, 1.0, "-", "... on this share of the sole")
    friction: float = number(0.6, 0.0, 2.0, "-", "sideways share of that load, which the wall carries")
    safety: float = number(2.0, 1.0, 10.0, "-", "least factor between a material's strength and the stress")
    density: float = number(0.0, 0.0, 10.0, "g/cm3", "of the printed material; 0 takes the material's")
    pad_density: float = number(1.15, 0.1, 5.0, "g/cm3", "of the pad's silicone")
    skin_density: float = number(1.2, 0.1, 5.0, "g/cm3", "of the taxels, mean of board and silicone")
    pad_hardness: float = number(40.0, 10.0, 90.0, "Shore A", "of the pad, where it is no foam")
    pad_foam: float = number(
        0.0, 0.0, 300.0, "kPa", "at which the pad's foam is compressed by 25 %; 0: rubber; strengthen may choose foam"
    )
    gap_press: float = length(0.0, 0.0, 2.0, "gap a side of what is pushed in, from your coupon; 0: the process's")
    gap_slide: float = length(0.0, 0.0, 2.0, "gap a side of what slides, from your coupon; 0: the process's")
    gap_play: float = length(0.0, 0.0, 2.0, "gap a side of what moves freely, from your coupon; 0: the process's")
    seat_scatter: float = length(0.0, 0.0, 1.0, "standard deviation of the seats' heights; 0: the process's")
    taxel_hardness: float = number(30.0, 10.0, 90.0, "Shore A", "of the taxels' rubber")
    flow: float = number(8.0, 0.5, 100.0, "mm3/s", "material the printer lays down, for the estimate of time")
    material: str = choice("PA12", tuple(MATERIALS), "printed material")
    process: str = choice("auto", ("auto", *PROCESSES), "how it is printed; auto: as the material usually is")
    retention: str = choice("auto", RETENTIONS, "how the shoe is held on the foot")
    pad_kind: str = choice("soft", ("soft", "plate"), "rubber or foam, or a printed plate, which a few cells need")
    use: str = choice(
        "contact",
        ("contact", "gait", "balance"),
        "what the center of pressure is for; its error may be 0.4 of the width, 0.05 of the length, 0.05 of the width",
    )
    strengthen: str = choice("yes", ("yes", "no"), "raise floor, wall, relief and softness of the pad as far as needed")

    def __post_init__(self) -> None:
        check_dimensions(self, "shoe parameter")
        for name in ("floor", "rib", "rim_thickness", "clip_thickness"):
            if getattr(self, name) < self.wall_min:
                raise InputError(
                    f"shoe parameter {name} is {getattr(self, name):g} mm; "
                    f"allowed: wall_min = {self.wall_min:g} mm or more"
                )
        if self.rib - 2.0 * self.scribe < 0.5 * self.wall_min:
            raise InputError(
                f"shoe parameter scribe is {self.scribe:g} mm; allowed: what leaves half of wall_min of a rib of "
                f"{self.rib:g} mm, {max(0.0, 0.5 * (self.rib - 0.5 * self.wall_min)):g} mm or less"
            )
        if self.scribe > 0.5 * self.pocket_depth:
            raise InputError(
                f"shoe parameter scribe is {self.scribe:g} mm; allowed: half of pocket_depth or less "
                f"({0.5 * self.pocket_depth:g} mm)"
            )
        if self.border > self.overhang_max + self.clearance + self.rim_thickness:
            raise InputError(
                f"shoe parameter border is {self.border:g} mm; "
                "allowed: what overhang_max, clearance and rim_thickness leave"
            )

    @property
    def bottom(self) -> float:
        """Printed lower face above the sole frame in mm."""
        return self.pad_thickness + self.taxel_protrusion

    @property
    def pad_rim_height(self) -> float:
        """Pad rim above its sheet in mm; 0 where the relief leaves none."""
        return max(0.0, self.taxel_protrusion - self.pad_relief)

    @property
    def ceiling(self) -> float:
        """Pocket ceiling above the sole frame in mm."""
        return self.bottom + self.pocket_depth

    @property
    def thickness(self) -> float:
        """Foot's face above the sole frame in mm."""
        return self.ceiling + self.floor

    @property
    def rim_top(self) -> float:
        """Wall's upper edge above the sole frame in mm."""
        return self.thickness + self.rim_height

    @property
    def printed(self) -> Material:
        material = MATERIALS[self.material]
        return replace(material, density=self.density or material.density)

    @property
    def pad_material(self) -> str:
        if self.pad_kind == "plate":
            return f"{self.material}, printed"
        if self.pad_foam > 0.0:
            return f"foam sheet, {self.pad_foam:g} kPa or less at 25 % (ASTM D1056, D3574)"
        return f"silicone, about {self.pad_hardness:g} Shore A"

    @property
    def made_by(self) -> Process:
        """Printing process with the given gaps and scatter."""
        process = PROCESSES[self.printed.process if self.process == "auto" else self.process]
        given: dict[str, Any] = {
            "press": self.gap_press,
            "slide": self.gap_slide,
            "play": self.gap_play,
            "scatter": self.seat_scatter,
        }
        return replace(process, **{name: value for name, value in given.items() if value > 0.0})

    def as_dict(self) -> dict[str, float | str]:
        """All parameters by name."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    @classmethod
    def range_of(cls, name: str) -> tuple[float, float, str, str]:
        """Range, unit and meaning of a numeric parameter.

        Raises:
            InputError: If unknown; lists all.
        """
        metadata = cls._metadata(name)
        if "choices" in metadata:
            raise InputError(f"shoe parameter {name} is a choice: {', '.join(metadata['choices'])}")
        return metadata["low"], metadata["high"], metadata["unit"], metadata["text"]

    @classmethod
    def _metadata(cls, name: str) -> Mapping[str, Any]:
        for f in fields(cls):
            if f.name == name:
                return f.metadata
        raise InputError(f"unknown shoe parameter '{name}'; allowed: {', '.join(f.name for f in fields(cls))}")

    @classmethod
    def table(cls) -> list[dict[str, Any]]:
        """Each parameter as a row: name, default, low, high, unit (or choices), text."""
        return [{"name": f.name, "default": f.default, **f.metadata} for f in fields(cls)]

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> "ShoeParameters":
        """Defaults with some values replaced.

        Raises:
            InputError: If unknown or unfit.
        """
        for name in values:
            cls._metadata(name)
        return cls(**values)

    def changed(self, settings: Iterable[str]) -> "ShoeParameters":
        """These parameters with some replaced, as by `--set`.

        Raises:
            InputError: If malformed, unknown or unfit.

        Example:
            >>> ShoeParameters().changed(["rim_height=16", "material=PETG"]).rim_height
            16.0
        """
        values: dict[str, float | str] = self.as_dict()
        for setting in settings:
            name, sign, text = (part.strip() for part in setting.partition("="))
            if not sign or not text:
                raise InputError(f"--set '{setting}' is not NAME=VALUE, for example --set rim_height=16")
            try:
                values[name] = float(text)
            except ValueError:
                values[name] = text
        return ShoeParameters.from_mapping(values)


def read_parameters(path: str | os.PathLike[str]) -> ShoeParameters:
    """Read shoe parameters in mm from `name = value` pairs in JSON or TOML, or the table "parameters" of a
    `check.json`.

    Raises:
        InputError: If unreadable, unknown or unfit.
    """
    file = Path(path)
    if file.suffix.lower() not in (".json", ".toml"):
        raise InputError(f"parameter file {file} ends in '{file.suffix}'; allowed: .json, .toml")
    read = read_json if file.suffix.lower() == ".json" else read_toml
    values = read(file, InputError, f"parameter file {file}")
    if isinstance(values, dict) and isinstance(values.get("parameters"), dict):
        values = values["parameters"]
    if not isinstance(values, dict):
        raise InputError(f"parameter file {file} is not a table of name = value pairs")
    if not values:
        raise InputError(f"parameter file {file} names no parameter; allowed: name = value pairs, or no such file")
    try:
        return ShoeParameters.from_mapping(values)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
