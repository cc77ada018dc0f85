"""Plantar perception: what a sole of taxels tells about the contact under a foot.

Data flows layout -> reading -> percept: a `SoleLayout` says where the taxels are, a `Reading` what they measured, and a
`Percept` computes what is asked of it, when it is asked.

The names below are loaded at first use (PEP 562), so that `import plantar.errors`, which the command line starts with,
does not load numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
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
    from plantar.layout import SoleLayout, mirrored
    from plantar.layout_file import read_layout, write_layout
    from plantar.percept import Percept
    from plantar.reading import Reading
    from plantar.support import feet_support_polygon
    from plantar.tiling import hex_layout

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

# Module of each name above that is not an error.
_MODULE_OF_NAME = {
    "HexLattice": "hex_lattice",
    "Percept": "percept",
    "Reading": "reading",
    "SoleLayout": "layout",
    "active_taxels": "activation",
    "center_of_pressure": "force",
    "feet_support_polygon": "support",
    "ground_reaction_wrench": "force",
    "hex_layout": "tiling",
    "mirrored": "layout",
    "read_layout": "layout_file",
    "wrench_at": "force",
    "write_layout": "layout_file",
    "zmp_of_feet": "force",
    "zmp_of_wrench": "force",
}

if not TYPE_CHECKING:  # a type checker reads the imports above, and reports a name that does not exist

    def __getattr__(name: str) -> object:
        """Load a public name at first use."""
        if name not in __all__:
            raise AttributeError(f"module 'plantar' has no attribute {name!r}")
        value = getattr(import_module(f"plantar.{_MODULE_OF_NAME.get(name, 'errors')}"), name)
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        """The public names, loaded or not, and what else the module holds."""
        return sorted({*globals(), *__all__})
