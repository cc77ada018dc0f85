"""Plantar perception: what a sole of taxels tells about the contact under a foot.

Data flows layout -> reading -> percept. The ten names that most people need:

    hex_layout, grid_layout    taxels on a sole, from its outline in m (x forward, y left)
    layout_of_cells            taxels of any shape: insoles, FSRs
    read_layout, write_layout  a sole's layout file (JSON), as `plantar shoe` writes it
    Reading                    what the taxels of one sole measured at one time: force, proximity, temperature
    Percept                    what that says of the contact: CoP, wrench, polygons, slope; computed when asked for
    FeetPercept, SolePose      the same of both feet in the world: ZMP, support polygon
    batch                      wrenches, CoP and polygons of a whole recording at once: a million frames in a second
    polygon                    area, margin, clipping and offsets of convex polygons

    >>> from plantar import Percept, Reading, hex_layout
    >>> sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]])
    >>> percept = Percept(sole, Reading(time=0.0, force=[20.0 if x > 0.0 else 0.0 for x in sole.positions[:, 0]]))
    >>> f"{percept.vertical_force:.0f} N, {1e3 * percept.position_cop_in_sole[0]:.0f} mm in front of the ankle"
    '440 N, 71 mm in front of the ankle'

Recordings: `plantar.formats.read_recording` reads a file of any known maker, `plantar.recordings.recorder.Recorder`
writes one while a robot runs, and `plantar.gait.analysis` measures the steps in it. A stream is read reading by
reading with `Percept`, or with `walking_tick`, which gives a controller what it needs of a foot in one call of 5 us;
`TaxelActivation` and `StuckMonitor` remember from one reading to the next. A file that is larger than memory goes
through `batch.blocks`.

Beside this package stand `shoes` (printable tactile shoes), `gait` (walking on plantar feedback), `wholebody` (skin
anywhere on a body) and `sim` (MuJoCo). SI units everywhere but inside `shoes`, which works in mm. Errors are classes of
`plantar.errors`, one line each. The folder `examples` has one idea a file; `plantar --help` is the command line.

The names are loaded at first use (PEP 562), so that `import plantar.errors`, which the command line starts with, does
not load numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plantar import batch
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
    from plantar.geometry import polygon
    from plantar.geometry.contact_rectangle import safe_rectangle
    from plantar.geometry.enclosing import bounding_box, enclosing_parallelogram, oriented_box
    from plantar.geometry.inscribed import (
        BoundedRectangle,
        Circle,
        inscribed_circle,
        inscribed_parallelogram,
        inscribed_rectangle,
        inscribed_rectangle_any_angle,
        inscribed_triangle,
        rectangle_in_outline,
        rectangle_in_outline_any_angle,
    )
    from plantar.geometry.outline import Outline, concave_outline, feet_outline
    from plantar.layouts.cell_layout import joined_layout, layout_of_cells
    from plantar.layouts.curved_sole import laid_over
    from plantar.layouts.hex_lattice import HexLattice
    from plantar.layouts.layout import SoleLayout, mirrored
    from plantar.layouts.layout_file import read_layout, write_layout
    from plantar.layouts.tiling import grid_layout, hex_layout
    from plantar.mechanics.lip import divergent_component
    from plantar.mechanics.wrench import wrench_at
    from plantar.mechanics.zmp import (
        centroidal_moment_pivot,
        zero_moment_wrench,
        zmp_in_plane,
        zmp_of_feet,
        zmp_of_wrench,
    )
    from plantar.percepts.feet import FeetPercept
    from plantar.percepts.foot_tick import FootTick, walking_tick
    from plantar.percepts.percept import Percept
    from plantar.percepts.percept_options import PerceptOptions
    from plantar.percepts.sole_pose import SolePose, wrench_of_feet, zmp_of_soles
    from plantar.percepts.support import feet_support_polygon
    from plantar.sensing.activation import TaxelActivation, active_taxels, hysteresis
    from plantar.sensing.body_skin import active_cells, patch_signal, pseudo_force, skin_wrench
    from plantar.sensing.force import center_of_pressure, ground_reaction_wrench
    from plantar.sensing.ground_plane import GroundPlane, fit_ground_plane, ground_points
    from plantar.sensing.health import StuckMonitor, TaxelHealth, fill_from_neighbours, stuck_taxels
    from plantar.sensing.pressure_wrench import joint_torque, pressure_driven_wrench
    from plantar.sensing.proximity import (
        HeightContour,
        height_contours,
        near_taxels,
        preemptive_polygon,
        proximity_measure,
    )
    from plantar.sensing.reading import Reading
    from plantar.sensing.temperature import temperature_footprint, temperature_wrench
    from plantar.sensing.virtual_wrench import (
        SoleWrenchSwitch,
        early_stop,
        sole_wrenches,
        virtual_ground_reaction_wrench,
    )

__version__ = "0.1.0"

__all__ = [
    "BoundedRectangle",
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
    "PerceptOptions",
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
    "batch",
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
    "polygon",
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
    "BoundedRectangle": "geometry.inscribed",
    "Circle": "geometry.inscribed",
    "FeetPercept": "percepts.feet",
    "FootTick": "percepts.foot_tick",
    "GroundPlane": "sensing.ground_plane",
    "HeightContour": "sensing.proximity",
    "HexLattice": "layouts.hex_lattice",
    "Outline": "geometry.outline",
    "Percept": "percepts.percept",
    "PerceptOptions": "percepts.percept_options",
    "Reading": "sensing.reading",
    "SoleLayout": "layouts.layout",
    "SolePose": "percepts.sole_pose",
    "SoleWrenchSwitch": "sensing.virtual_wrench",
    "StuckMonitor": "sensing.health",
    "TaxelActivation": "sensing.activation",
    "TaxelHealth": "sensing.health",
    "active_cells": "sensing.body_skin",
    "active_taxels": "sensing.activation",
    "batch": "batch",
    "bounding_box": "geometry.enclosing",
    "center_of_pressure": "sensing.force",
    "centroidal_moment_pivot": "mechanics.zmp",
    "concave_outline": "geometry.outline",
    "divergent_component": "mechanics.lip",
    "early_stop": "sensing.virtual_wrench",
    "enclosing_parallelogram": "geometry.enclosing",
    "feet_outline": "geometry.outline",
    "feet_support_polygon": "percepts.support",
    "fill_from_neighbours": "sensing.health",
    "fit_ground_plane": "sensing.ground_plane",
    "grid_layout": "layouts.tiling",
    "ground_points": "sensing.ground_plane",
    "ground_reaction_wrench": "sensing.force",
    "height_contours": "sensing.proximity",
    "hex_layout": "layouts.tiling",
    "hysteresis": "sensing.activation",
    "inscribed_circle": "geometry.inscribed",
    "inscribed_parallelogram": "geometry.inscribed",
    "inscribed_rectangle": "geometry.inscribed",
    "inscribed_rectangle_any_angle": "geometry.inscribed",
    "inscribed_triangle": "geometry.inscribed",
    "joined_layout": "layouts.cell_layout",
    "joint_torque": "sensing.pressure_wrench",
    "laid_over": "layouts.curved_sole",
    "layout_of_cells": "layouts.cell_layout",
    "mirrored": "layouts.layout",
    "near_taxels": "sensing.proximity",
    "oriented_box": "geometry.enclosing",
    "patch_signal": "sensing.body_skin",
    "polygon": "geometry",
    "preemptive_polygon": "sensing.proximity",
    "pressure_driven_wrench": "sensing.pressure_wrench",
    "proximity_measure": "sensing.proximity",
    "pseudo_force": "sensing.body_skin",
    "read_layout": "layouts.layout_file",
    "rectangle_in_outline": "geometry.inscribed",
    "rectangle_in_outline_any_angle": "geometry.inscribed",
    "safe_rectangle": "geometry.contact_rectangle",
    "skin_wrench": "sensing.body_skin",
    "sole_wrenches": "sensing.virtual_wrench",
    "stuck_taxels": "sensing.health",
    "temperature_footprint": "sensing.temperature",
    "temperature_wrench": "sensing.temperature",
    "virtual_ground_reaction_wrench": "sensing.virtual_wrench",
    "walking_tick": "percepts.foot_tick",
    "wrench_at": "mechanics.wrench",
    "wrench_of_feet": "percepts.sole_pose",
    "write_layout": "layouts.layout_file",
    "zero_moment_wrench": "mechanics.zmp",
    "zmp_in_plane": "mechanics.zmp",
    "zmp_of_feet": "mechanics.zmp",
    "zmp_of_soles": "percepts.sole_pose",
    "zmp_of_wrench": "mechanics.zmp",
}

if not TYPE_CHECKING:  # a type checker reads the imports above, and reports a name that does not exist

    def __getattr__(name: str) -> object:
        """Load a public name at first use."""
        if name not in __all__:
            raise AttributeError(f"module 'plantar' has no attribute {name!r}")
        place = f"plantar.{_MODULE_OF_NAME.get(name, 'errors')}"
        module = import_module(place)
        value = getattr(module, name) if hasattr(module, name) else import_module(f"{place}.{name}")
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        """The public names, loaded or not, and what else the module holds."""
        return sorted({*globals(), *__all__})
