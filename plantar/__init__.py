"""Plantar perception: what a sole of taxels tells about the contact under a foot.

Data flows layout -> reading -> percept: a `SoleLayout` says where the taxels are, a `Reading` what they measured, and a
`Percept` computes what is asked of it, when it is asked.
"""

from plantar.activation import active_taxels
from plantar.errors import (
    DependencyError,
    FootError,
    FormatError,
    InputError,
    LayoutError,
    PlantarError,
    ReadingError,
    RecordingError,
    RobotError,
    SceneError,
)
from plantar.force import center_of_pressure, ground_reaction_wrench, wrench_at, zmp_of_feet, zmp_of_wrench
from plantar.hex_lattice import HexLattice
from plantar.layout import SoleLayout, hex_layout, mirrored
from plantar.layout_file import read_layout, write_layout
from plantar.percept import Percept
from plantar.reading import Reading
from plantar.support import feet_support_polygon

__version__ = "0.1.0"

__all__ = [
    "DependencyError",
    "FootError",
    "FormatError",
    "HexLattice",
    "InputError",
    "LayoutError",
    "Percept",
    "PlantarError",
    "Reading",
    "ReadingError",
    "RecordingError",
    "RobotError",
    "SceneError",
    "SoleLayout",
    "__version__",
    "active_taxels",
    "center_of_pressure",
    "feet_support_polygon",
    "ground_reaction_wrench",
    "hex_layout",
    "mirrored",
    "read_layout",
    "wrench_at",
    "write_layout",
    "zmp_of_feet",
    "zmp_of_wrench",
]
