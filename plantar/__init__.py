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
    from plantar.activation import TaxelActivation, active_taxels, hysteresis
    from plantar.body_skin import active_cells, patch_signal, pseudo_force, skin_wrench
    from plantar.cell_layout import joined_layout, layout_of_cells
    from plantar.contact_rectangle import safe_rectangle
    from plantar.curved_sole import laid_over
    from plantar.enclosing import bounding_box, enclosing_parallelogram, oriented_box
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
    from plantar.feet import FeetPercept
    from plantar.foot_tick import FootTick, walking_tick
    from plantar.force import center_of_pressure, ground_reaction_wrench, wrench_at, zmp_of_feet, zmp_of_wrench
    from plantar.ground_plane import GroundPlane, fit_ground_plane, ground_points
    from plantar.health import StuckMonitor, TaxelHealth, fill_from_neighbours, stuck_taxels
    from plantar.hex_lattice import HexLattice
    from plantar.inscribed import (
        Circle,
        inscribed_circle,
        inscribed_parallelogram,
        inscribed_rectangle,
        inscribed_rectangle_any_angle,
        inscribed_triangle,
        rectangle_in_outline,
        rectangle_in_outline_any_angle,
    )
    from plantar.layout import SoleLayout, mirrored
    from plantar.layout_file import read_layout, write_layout
    from plantar.outline import Outline, concave_outline, feet_outline
    from plantar.percept import Percept
    from plantar.pressure_wrench import joint_torque, pressure_driven_wrench
    from plantar.proximity import HeightContour, height_contours, near_taxels, preemptive_polygon, proximity_measure
    from plantar.reading import Reading
    from plantar.sole_pose import SolePose, wrench_of_feet, zmp_of_soles
    from plantar.support import feet_support_polygon
    from plantar.temperature import temperature_footprint, temperature_wrench
    from plantar.tiling import grid_layout, hex_layout
    from plantar.virtual_wrench import SoleWrenchSwitch, early_stop, sole_wrenches, virtual_ground_reaction_wrench
    from plantar.zmp import centroidal_moment_pivot, divergent_component, zero_moment_wrench, zmp_in_plane

__version__ = "0.1.0"

__all__ = [
    "Circle",
    "DependencyError",
    "FeetPercept",
    "FootError",
    "FootTick",
    "FormatError",
    "GroundPlane",
    "HeightContour",
    "HexLattice",
    "InputError",
    "LayoutError",
    "Outline",
    "Percept",
    "PlantarError",
    "Reading",
    "ReadingError",
    "RecordingError",
    "RobotError",
    "SceneError",
    "SoleLayout",
    "SolePose",
    "SoleWrenchSwitch",
    "StuckMonitor",
    "TaxelActivation",
    "TaxelHealth",
    "__version__",
    "active_cells",
    "active_taxels",
    "bounding_box",
    "center_of_pressure",
    "centroidal_moment_pivot",
    "concave_outline",
    "divergent_component",
    "early_stop",
    "enclosing_parallelogram",
    "feet_outline",
    "feet_support_polygon",
    "fill_from_neighbours",
    "fit_ground_plane",
    "grid_layout",
    "ground_points",
    "ground_reaction_wrench",
    "height_contours",
    "hex_layout",
    "hysteresis",
    "inscribed_circle",
    "inscribed_parallelogram",
    "inscribed_rectangle",
    "inscribed_rectangle_any_angle",
    "inscribed_triangle",
    "joined_layout",
    "joint_torque",
    "laid_over",
    "layout_of_cells",
    "mirrored",
    "near_taxels",
    "oriented_box",
    "patch_signal",
    "preemptive_polygon",
    "pressure_driven_wrench",
    "proximity_measure",
    "pseudo_force",
    "read_layout",
    "rectangle_in_outline",
    "rectangle_in_outline_any_angle",
    "safe_rectangle",
    "skin_wrench",
    "sole_wrenches",
    "stuck_taxels",
    "temperature_footprint",
    "temperature_wrench",
    "virtual_ground_reaction_wrench",
    "walking_tick",
    "wrench_at",
    "wrench_of_feet",
    "write_layout",
    "zero_moment_wrench",
    "zmp_in_plane",
    "zmp_of_feet",
    "zmp_of_soles",
    "zmp_of_wrench",
]

# Module of each name above that is not an error.
_MODULE_OF_NAME = {
    "Circle": "inscribed",
    "FeetPercept": "feet",
    "FootTick": "foot_tick",
    "GroundPlane": "ground_plane",
    "HeightContour": "proximity",
    "HexLattice": "hex_lattice",
    "Outline": "outline",
    "Percept": "percept",
    "Reading": "reading",
    "SoleLayout": "layout",
    "SolePose": "sole_pose",
    "SoleWrenchSwitch": "virtual_wrench",
    "StuckMonitor": "health",
    "TaxelActivation": "activation",
    "TaxelHealth": "health",
    "active_cells": "body_skin",
    "active_taxels": "activation",
    "bounding_box": "enclosing",
    "center_of_pressure": "force",
    "centroidal_moment_pivot": "zmp",
    "concave_outline": "outline",
    "divergent_component": "zmp",
    "early_stop": "virtual_wrench",
    "enclosing_parallelogram": "enclosing",
    "feet_outline": "outline",
    "feet_support_polygon": "support",
    "fill_from_neighbours": "health",
    "fit_ground_plane": "ground_plane",
    "grid_layout": "tiling",
    "ground_points": "ground_plane",
    "ground_reaction_wrench": "force",
    "height_contours": "proximity",
    "hex_layout": "tiling",
    "hysteresis": "activation",
    "inscribed_circle": "inscribed",
    "inscribed_parallelogram": "inscribed",
    "inscribed_rectangle": "inscribed",
    "inscribed_rectangle_any_angle": "inscribed",
    "inscribed_triangle": "inscribed",
    "joined_layout": "cell_layout",
    "joint_torque": "pressure_wrench",
    "laid_over": "curved_sole",
    "layout_of_cells": "cell_layout",
    "mirrored": "layout",
    "near_taxels": "proximity",
    "oriented_box": "enclosing",
    "patch_signal": "body_skin",
    "preemptive_polygon": "proximity",
    "pressure_driven_wrench": "pressure_wrench",
    "proximity_measure": "proximity",
    "pseudo_force": "body_skin",
    "read_layout": "layout_file",
    "rectangle_in_outline": "inscribed",
    "rectangle_in_outline_any_angle": "inscribed",
    "safe_rectangle": "contact_rectangle",
    "skin_wrench": "body_skin",
    "sole_wrenches": "virtual_wrench",
    "stuck_taxels": "health",
    "temperature_footprint": "temperature",
    "temperature_wrench": "temperature",
    "virtual_ground_reaction_wrench": "virtual_wrench",
    "walking_tick": "foot_tick",
    "wrench_at": "force",
    "wrench_of_feet": "sole_pose",
    "write_layout": "layout_file",
    "zero_moment_wrench": "zmp",
    "zmp_in_plane": "zmp",
    "zmp_of_feet": "force",
    "zmp_of_soles": "sole_pose",
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
