"""Options of a shoe; light, so that help needs no geometry."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar


def _option(default: Any, text: str, metavar: str | None = None) -> Any:
    return field(default=default, metadata={"help": text, "metavar": metavar})


@dataclass(frozen=True)
class FootSource:
    """Foot source: a file, built-in robot or dimensions; the rest describes file reading.

    Example:
        >>> FootSource(robot="h1").file is None
        True
    """

    TITLE: ClassVar[str] = "The foot"

    file: Path | None = None
    robot: str | None = _option(None, "A built-in robot instead of a file, for example h1.")
    body: str | None = _option(None, "Name of the foot's body or link in a robot's model.")
    dimensions: str | None = _option(
        None, "Length, width and corner radius of a box instead of a file, in mm.", metavar="LxW[xR]"
    )
    mesh_side: str | None = _option(
        None, "Which foot the file shows. Default: by the body's or file's name, or left.", metavar="left|right"
    )
    unit: str | None = _option(None, "Unit of the file. Default: from its size.", metavar="m|cm|mm|in")
    up: str | None = _option(None, "Axis that points up. Default: found.", metavar="x|-x|y|-y|z|-z")
    forward: str | None = _option(None, "Axis to the toes. Default: found.", metavar="x|-x|y|-y")
    shank: str | None = _option(
        None,
        "Where the shank passes above a foot without a robot's model, from its origin in mm; straps keep off it. "
        "Default: assumed about the ankle.",
        metavar="X,Y,DIAMETER",
    )
    sole_z: float | None = _option(None, "Height of the sole plane in the mesh, in mm. Default: its lowest point.")


@dataclass(frozen=True)
class ShoeOrder:
    """What is built for the foot, checked by `plantar.shoes.ordered.build_ordered`.

    Example:
        >>> ShoeOrder().cell_area
        691.0
    """

    TITLE: ClassVar[str] = "What is made"

    side: str = _option("both", "Which shoes; the right one mirrors the left.", metavar="left|right|both")
    cell_area: float = _option(691.0, "Area of one taxel in mm^2, as the papers give it.")
    taxels: int | None = _option(
        None, "Number of taxels; may reach beyond the sole as far as needed. Default: as many as fit."
    )
    overhang: float = _option(0.0, "How far taxels may reach beyond the sole, in mm.")
    rim: str | None = _option(
        None,
        "Cells along the edge: whole, or fine for a row of smaller ones and a blind rim of 12 mm at most. "
        "Default: whole; of an insole fine.",
        metavar="whole|fine",
    )
    cell: str | None = _option(
        None,
        "Other cells: auto (by the robot's weight), fsr_402, fsr_402_short, fsr_406, velostat, fx29_25, fx29_100, "
        "fx29_200, hex, or a TOML file of the cell's body (docs/shoes.md). Default: a laboratory's hexagons of "
        "--cell-area.",
        metavar="CELL",
    )
    name: str | None = _option(None, "Name of the shoe. Default: that of the file or robot.")
    insole: float | None = _option(
        None,
        "Make a flat insole for a person's foot instead of a shoe, so thick in mm (4 to 15), pad included.",
        metavar="MM",
    )
    coupon: bool = _option(False, "Only a print to try the fit of one cell and one clip or lug, in the same sizes.")
    layout_only: bool = _option(False, "Write only the layouts (under 2 s).")
