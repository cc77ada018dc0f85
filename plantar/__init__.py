"""Plantar: tactile soles and gait, for robots and people.

Doors, each documented by `help(plantar.NAME)`; what a door needs is loaded at its first use:

    read(file)                   a recording of any known maker as a `PressureRecording`
    analyse(recording or file)   steps, timing, loads and figures of a recording, a folder, an array or a data frame
    sole(recording, at, foot)    what a sole perceives at an instant: CoP, wrench, polygons, contours, as a picture
    view([file, ...], page)      a page for the browser that plays one or two recordings
    load_robot(name or file)     a robot: model, legs, soles
    load_controller(robot)       its walking controller, for a control loop of your own; needs no simulator
    load_scene(name or file)     a scene for the simulator
    run(scene, seed)             simulate it, judge it by the true contact forces, and record it
    mujoco                       the same skin for any MuJoCo model
    calibrate(takes, layout)     counts of soles into newtons, with the uncertainty of each gain
    shoes.build_shoe(foot)       a printable shoe with taxels for a robot's foot, from its mesh or model
    live.open_live(source)       readings as they come, from a serial port, the network, a file or a program

What a sole measures, and what follows from it:

    hex_layout, grid_layout      taxels on a sole, from its outline in m (x forward, y left)
    layout_of_cells              taxels of any shape: insoles, FSRs
    read_layout, write_layout    a sole's layout file (JSON), as `plantar shoe` writes it
    Reading                      forces, proximity and temperature of one sole's taxels at one time
    Percept                      contact of one sole: CoP, wrench, polygons, slope; each computed at first use
    FeetPercept, SolePose        the same of both feet in the world: ZMP, support polygon
    walking_tick                 what a controller needs of one foot, in one call
    batch                        wrenches, CoP and polygons of a whole recording at once
    polygon                      area, margin, clipping and offsets of convex polygons

    >>> from plantar import Percept, Reading, hex_layout
    >>> sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]])
    >>> percept = Percept(sole, Reading(time=0.0, force=[20.0 if x > 0.0 else 0.0 for x in sole.positions[:, 0]]))
    >>> f"{percept.vertical_force:.0f} N, {1e3 * percept.position_cop_in_sole[0]:.0f} mm in front of the ankle"
    '440 N, 71 mm in front of the ankle'

Packages: `plantar.gait` walks, `plantar.gait.analysis` measures gait, `plantar.robots` holds robots,
`plantar.wholebody` reacts to skin anywhere on a body, `plantar.sim` simulates (MuJoCo), `plantar.shoes` builds
printable tactile shoes. Units are SI, and mm inside `plantar.shoes`. Errors are classes of `plantar.errors`. `plantar
--help` is the command line; `examples` has one idea a file.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from plantar.common.version import VERSION as __version__

if TYPE_CHECKING:
    from plantar import batch, live, mujoco, shoes
    from plantar.calibration.calibrated import calibrate
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
    from plantar.formats import read_recording as read
    from plantar.gait.analysis.analyse import analyse
    from plantar.gait.analysis.analyse import analyse as analyze
    from plantar.geometry import polygon
    from plantar.layouts.cell_layout import joined_layout, layout_of_cells
    from plantar.layouts.curved_sole import laid_over
    from plantar.layouts.layout import SoleLayout, mirrored
    from plantar.layouts.layout_file import read_layout, write_layout
    from plantar.layouts.tiling import grid_layout, hex_layout
    from plantar.percepts.feet import FeetPercept
    from plantar.percepts.foot_tick import FootTick, walking_tick
    from plantar.percepts.percept import Percept
    from plantar.percepts.percept_options import PerceptOptions
    from plantar.percepts.sole_pose import SolePose
    from plantar.robots.controller import load_controller
    from plantar.robots.robot_file import load_robot
    from plantar.sensing.activation import TaxelActivation
    from plantar.sensing.ground_plane import GroundPlane, fit_ground_plane
    from plantar.sensing.health import StuckMonitor
    from plantar.sensing.reading import Reading
    from plantar.sim.run.scene_kind import open_scene as load_scene
    from plantar.sim.run.scene_kind import run
    from plantar.viewer.page import write_page as view
    from plantar.viewer.sole_view import sole


__all__ = [
    "DependencyError",
    "FeetPercept",
    "FootError",
    "FootTick",
    "FormatError",
    "GroundPlane",
    "InputError",
    "LayoutError",
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
    "StuckMonitor",
    "TaxelActivation",
    "__version__",
    "analyse",
    "analyze",
    "batch",
    "calibrate",
    "fit_ground_plane",
    "grid_layout",
    "hex_layout",
    "joined_layout",
    "laid_over",
    "layout_of_cells",
    "live",
    "load_controller",
    "load_robot",
    "load_scene",
    "mirrored",
    "mujoco",
    "polygon",
    "read",
    "read_layout",
    "run",
    "shoes",
    "sole",
    "view",
    "walking_tick",
    "write_layout",
]

# Module below plantar of each name that is not an error, and what it is called there where that differs
_PLACES = {
    "FeetPercept": "percepts.feet",
    "FootTick": "percepts.foot_tick",
    "GroundPlane": "sensing.ground_plane",
    "Percept": "percepts.percept",
    "PerceptOptions": "percepts.percept_options",
    "Reading": "sensing.reading",
    "SoleLayout": "layouts.layout",
    "SolePose": "percepts.sole_pose",
    "StuckMonitor": "sensing.health",
    "TaxelActivation": "sensing.activation",
    "analyse": "gait.analysis.analyse",
    "analyze": "gait.analysis.analyse:analyse",
    "calibrate": "calibration.calibrated",
    "fit_ground_plane": "sensing.ground_plane",
    "grid_layout": "layouts.tiling",
    "hex_layout": "layouts.tiling",
    "joined_layout": "layouts.cell_layout",
    "laid_over": "layouts.curved_sole",
    "layout_of_cells": "layouts.cell_layout",
    "load_controller": "robots.controller",
    "load_robot": "robots.robot_file",
    "load_scene": "sim.run.scene_kind:open_scene",
    "mirrored": "layouts.layout",
    "read": "formats:read_recording",
    "read_layout": "layouts.layout_file",
    "run": "sim.run.scene_kind",
    "sole": "viewer.sole_view",
    "view": "viewer.page:write_page",
    "walking_tick": "percepts.foot_tick",
    "write_layout": "layouts.layout_file",
    "batch": "",
    "live": "",
    "mujoco": "",
    "shoes": "",
    "polygon": "geometry",
}

if not TYPE_CHECKING:  # a type checker reads the imports above, and reports a name that does not exist

    def __getattr__(name: str) -> object:
        """Load a public name at first use (PEP 562): `plantar --help` does not wait for numpy."""
        if name not in __all__:
            raise AttributeError(f"module 'plantar' has no attribute {name!r}")
        place, _, called = _PLACES.get(name, "errors").partition(":")
        place = f"plantar.{place}".rstrip(".")
        missing_libraries = import_module("plantar.common.optional_library").missing_libraries
        with missing_libraries("sim"):
            module = import_module(place) if place != "plantar" else None
            value = getattr(module, called or name, None)
            value = import_module(f"{place}.{name}") if value is None else value
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        """The public names, loaded or not, and what else the module holds."""
        return sorted({*globals(), *__all__})
