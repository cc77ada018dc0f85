"""Public functions of the perception that take arrays, each with a right call: what wrong calls are made of."""

import inspect
import pkgutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar import batch
from plantar.geometry import enclosing, inscribed, outline, polygon
from plantar.geometry.cell_cutting import CellCutter, half_planes
from plantar.layouts import cell_edges, cell_layout, curved_sole, taxel_values, tiling
from plantar.layouts.calibration import CountStream, SoleCalibration
from plantar.layouts.hex_lattice import HexLattice
from plantar.layouts.layout import SoleLayout
from plantar.mechanics import external_wrench, lip, wrench, zmp
from plantar.percepts import foot_tick, sole_pose
from plantar.percepts.percept import Percept
from plantar.sensing import (
    activation,
    body_skin,
    clipping,
    force,
    ground_plane,
    health,
    identify_faults,
    link_skin,
    net_wrench,
    partial_contact,
    proximity,
    taxel_faults,
    temperature,
    virtual_wrench,
)
from plantar.sensing.reading import Reading

from ...public_names import public_names

__all__ = ["INNER", "Argument", "Call", "array_functions", "public_calls"]

Array = NDArray[Any]

ROOMS = ("geometry", "layouts", "mechanics", "percepts", "sensing")
"""Rooms whose functions take arrays from callers."""

INNER: frozenset[str] = frozenset(
    {
        # Called some hundred times a control tick with arrays that the library made; they take float64 of their shape.
        *(f"rotation.{name}" for name in ("heading", "orthonormalised", "rotation_error", "rotation_from_vector")),
        *(f"rotation.{name}" for name in ("sine_vector", "vector_from_rotation")),
        "reading.Reading.taken_over",
        "source_pose.SourcePose",  # made by the fit of a shoe, and by the reader of layout files, which checks it
        "leg_inertia.LegInertia.base_acceleration",
        *("wrench.wrench_in_frame", "contact.Contact", "contact.Contact.wrench_in_world"),
        *("link_skin.LinkWrench", "link_skin.link_wrenches", "net_wrench.NetWrench"),
        *("within_limits.Box", "within_limits.Box.of", "within_limits.nearest_within"),
        *(f"wrench_distribution.WrenchDistribution.{name}" for name in ("program", "solve")),
        "wrench_distribution.Program",
        *("cell_edges.cells_overlap", "taxel_values.without_dead"),
        # Made by the fit and by the reader of layout files, which checks each field.
        *("calibration.SoleCalibration", "calibration.response"),
        *("calibration.LoopState", "calibration.LoopState.advance"),
        # Made and asked by the reader of walkways and by prints, with cells of the grid.
        *(f"cell_grid.CellGrid{name}" for name in ("", ".cell_rings", ".groups", ".of_cells", ".ends_of_rows")),
        "layout.SoleLayout.cell_rings",
        *("cell_patch.pressed_patch", "cell_patch.reach_of"),
        # Called by those that lay out cells, whose own calls hand it wrong outlines.
        "cell_layout.checked_ring",
        *("cell_cutting.CellCutter.of_polygons", "polygon.part_inside"),
        # Takes surfaces that readers of meshes have checked.
        "hull_plane.hull_plane",
        # What functions return; nobody else makes them.
        *("batch.GroundPlanes", "batch.Loads", "batch.SupportPolygons", "partial_contact.GroundEdges"),
        *(
            "health.TaxelHealth",
            "ground_plane.GroundPlane",
            "proximity.HeightContour",
            "inscribed.Circle",
        ),
        *("foot_tick.FootTick", "base_state.BaseState", "wrench_distribution.WrenchShare"),
        # Takes a function of arrays.
        "curved_sole.laid_over",
        # Its arrays go with a name, a link and thresholds; its own tests hand it wrong ones.
        "link_skin.SkinPatch",
        # Made by `TaxelFaults.worn` and `identify_faults`.
        *("taxel_faults.WornFaults", "taxel_faults.WornFaults.rubbed", "identify_faults.IdentifiedFaults"),
        # Hands views of what it is given to the caller, who may pass a memory map.
        "batch.blocks",
    }
)
"""Functions that take no arrays from callers, though they take arrays."""


@dataclass(frozen=True)
class Argument:
    """An array that a function takes.

    Attributes:
        value: A right one.
        shape: What its shape may be: numbers, letters for any length (the same letter, the same length), `...` in front
            for any axes.
        called: Words of which an error has one.
        nan: Whether values that are not finite are allowed, as of a taxel that is dead.
        optional: Whether None is allowed.
        truth: Whether it holds truth values.
        least: Rows that it needs.
    """

    value: Any
    shape: tuple[Any, ...]
    called: str
    nan: bool = False
    optional: bool = False
    truth: bool = False
    least: int = 0

    def fits(self, shape: tuple[int, ...]) -> bool:
        """Whether a shape may be one of this argument by itself."""
        wanted = self.shape
        if wanted and wanted[0] is ...:
            wanted = wanted[1:]
            shape = shape[len(shape) - len(wanted) :] if len(shape) >= len(wanted) else (-1,)
        if shape == (0,) and not self.least and (len(wanted) == 2 or self.shape == (..., 2)):
            return True  # an empty list is no points
        same = len(shape) == len(wanted)
        return same and all(isinstance(w, str) or w == s for w, s in zip(wanted, shape, strict=True))

    def letters(self, shape: tuple[int, ...]) -> dict[str, int]:
        """Length that a shape gives each letter."""
        last = [w for w in self.shape if w is not ...]
        return {w: s for w, s in zip(last, shape[len(shape) - len(last) :], strict=False) if isinstance(w, str)}


@dataclass(frozen=True)
class Call:
    """A function and right arguments.

    Attributes:
        name: Module and name of the function.
        function: Takes the arrays by name.
        arrays: The arrays.
    """

    name: str
    function: Callable[..., Any]
    arrays: dict[str, Argument]

    def __call__(self, **changed: Any) -> Any:
        """What the function gives, some arrays changed."""
        return self.function(**{k: a.value for k, a in self.arrays.items()} | changed)

    def taken(self, name: str, shape: tuple[int, ...]) -> bool:
        """Whether a shape of one array goes with the others."""
        if not self.arrays[name].fits(shape):
            return False
        known: dict[str, int] = {}
        for other, argument in self.arrays.items():
            if other != name and argument.value is not None:
                known |= argument.letters(np.shape(argument.value))
        return all(known.get(k, n) == n for k, n in self.arrays[name].letters(shape).items())


def array_functions() -> Iterator[str]:
    """Module and name of every public function, constructor and method of the rooms that takes an array."""
    rooms = [f"plantar.{room}" for room in ROOMS]
    inside = [f"{r}.{m.name}" for r in rooms for m in pkgutil.iter_modules(import_module(r).__path__)]
    for module in map(import_module, [*inside, "plantar.batch"]):
        for name in public_names(module):
            value = getattr(module, name)
            if getattr(value, "__module__", None) != module.__name__:
                continue
            members = {"": value}
            if inspect.isclass(value):
                members |= {f".{k}": getattr(value, k) for k in vars(value) if not k.startswith("_")}
            called = module.__name__.rpartition(".")[2]
            yield from (f"{called}.{name}{k}" for k, member in members.items() if _takes_array(member))


def _takes_array(function: Any) -> bool:
    if not callable(function):
        return False
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return False
    words = ("ArrayLike", "NDArray", "numpy.ndarray", "_SupportsArray")  # as text, and what they stand for
    return any(word in str(p.annotation) for p in parameters for word in words)


def public_calls() -> list[Call]:
    """A right call of every function that takes arrays, made anew."""
    sole = tiling.hex_layout(_OUTLINE, cell_area=900e-6)
    return [
        *_of_polygons(sole),
        *_of_layouts(sole),
        *_of_mechanics(),
        *_of_readings(sole),
        *_of_fields(sole),
        *_of_wrenches(sole),
        *_of_batches(sole),
        *_of_objects(sole),
        *_of_calibrations(sole),
    ]


_OUTLINE = np.array([[-0.125, -0.0625], [0.125, -0.0625], [0.125, 0.0625], [-0.125, 0.0625]])
_RING = np.array([[0.0, 0.0], [0.25, 0.0], [0.25, 0.125], [0.125, 0.25], [0.0, 0.125]])
_TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
_WRENCH = np.array([1.0, -2.0, 64.0, 0.5, -0.25, 0.125])


def _force(n: int) -> Array:
    return np.arange(n) % 5 * 4.0


def _distance(n: int) -> Array:
    return 0.015625 + 0.0078125 * (np.arange(n) % 4)


def _polygon(called: str = "polygon", nan: bool = False) -> Argument:
    return Argument(_RING, ("k", 2), called, nan=nan)


def _name(function: Any) -> str:
    return f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}"


def _call(function: Any, **arrays: Argument) -> Call:
    """A function, or a partial one, with right arrays."""
    return Call(_name(getattr(function, "func", function)), function, arrays)


def _of_polygons(sole: SoleLayout) -> list[Call]:
    point = Argument(np.array([0.5, 0.25]), (2,), "point", nan=True)
    active = Argument(_force(len(sole)) > 4.0, (len(sole),), "mask", truth=True)
    shapes = [
        *(enclosing.enclosing_parallelogram, enclosing.oriented_box),
        *(inscribed.inscribed_circle, inscribed.inscribed_parallelogram, inscribed.inscribed_rectangle),
        *(inscribed.inscribed_rectangle_any_angle, inscribed.inscribed_triangle),
    ]
    found = [_call(f, polygon=_polygon()) for f in shapes]
    found += [_call(f, polygon=_polygon()) for f in (polygon.area, polygon.centroid, polygon.convex_ring)]
    found += [_call(f, points=_polygon("points polygon", nan=True)) for f in (polygon.convex_hull,)]
    found += [_call(f, points=_polygon("points polygon")) for f in (enclosing.bounding_box,)]
    pairs = [polygon.closest_point, polygon.signed_margin]
    found += [_call(f, polygon=_polygon(), point=point) for f in pairs]
    frame = {
        "polygon_in_sole": _polygon(),
        "rotation_sole_to_world": Argument(_TURN, (3, 3), "rotation"),
        "position_sole_in_world": Argument(np.array([1.0, 2.0, 0.5]), (3,), "position"),
    }
    return [
        *found,
        _call(partial(polygon.inner_offset, distance=0.03125), polygon=_polygon()),
        _call(partial(inscribed.safe_rectangle, offset=0.03125), polygon=_polygon()),
        _call(partial(outline.concave_outline, sole), active=active),
        _call(sole_pose.polygon_in_world, **frame),
        Call(
            _name(sole_pose.feet_support_polygon),
            lambda polygon: sole_pose.feet_support_polygon([polygon, _RING]),
            {"polygon": _polygon()},
        ),
        _call(half_planes, lines=Argument(_LINES, ("k", 3), "lines")),
        _call(CellCutter(sole).cut, lines=Argument(_LINES, ("k", 3), "lines")),
    ]


_LINES = np.array([[1.0, 0.0, 0.03125], [0.0, 1.0, 0.015625]])


def _of_layouts(sole: SoleLayout) -> list[Call]:
    rim = Argument(_OUTLINE, ("k", 2), "outline polygon", least=3)
    lattice = HexLattice(0.0009765625)
    axial = Argument(np.array([[0, 0], [1, -1], [2, 3]]), (..., 2), "axial cells")
    keys = Argument(lattice.centre_keys(axial.value), (..., 2), "keys")
    corner = Argument(np.array([-0.125, -0.0625]), (2,), "lower upper corner box bounds")
    cells = [np.array([[i, 0.0], [i + 1.0, 0.0], [i + 1.0, 1.0], [i, 1.0]]) * 0.125 for i in range(3)]
    cell = Argument(cells[1], ("k", 2), "cell ring polygon", least=3)
    vertices = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    return [
        _call(partial(tiling.hex_layout, cell_area=900e-6), outline=rim),
        _call(partial(tiling.grid_layout, pitch=(0.03125, 0.03125)), outline=rim),
        _call(lattice.cells_near, lower=corner, upper=Argument(-corner.value, (2,), corner.called)),
        *(_call(f, axial=axial) for f in (lattice.centre_keys, lattice.centres, lattice.corner_keys, lattice.corners)),
        _call(lattice.position_of_keys, keys=keys),
        Call(
            "cell_layout.layout_of_cells",
            lambda cell: cell_layout.layout_of_cells([cells[0], cell, cells[2]]),
            {"cell": cell},
        ),
        _call(
            partial(cell_layout.joined_layout, [sole]),
            outline=Argument(_OUTLINE, ("k", 2), "outline polygon", optional=True, least=3),
        ),
        Call(
            "cell_layout.shared_vertices",
            lambda ring: cell_layout.shared_vertices([cells[0], ring], 1e-9),
            {"ring": _polygon("ring")},
        ),
        _call(
            partial(cell_edges.edge_table, corners=[(0, 1, 2, 3)]), vertices=Argument(vertices, ("k", 2), "vertices")
        ),
        _call(
            curved_sole.rotations_to_normals,
            normals=Argument(np.array([[0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]), ("k", 3), "normals directions taxel"),
        ),
        Call("layout.SoleLayout", lambda **arrays: _layout_with(sole, arrays), _arrays_of(sole)),
        _call(partial(taxel_values.taxel_frames, sole), values=_reading(sole, frames=True)),
        _call(partial(taxel_values.taxel_values, sole), values=_reading(sole)),
        _call(partial(taxel_values.taxel_mask, sole), values=_mask(sole)),
    ]


def _reading(sole: SoleLayout, called: str = "force", frames: bool = False) -> Argument:
    n = len(sole)
    value = np.stack([_force(n), _force(n)[::-1]]) if frames else _force(n)
    return Argument(value, (..., n) if frames else (n,), called, nan=True)


def _of_calibrations(sole: SoleLayout) -> list[Call]:
    n = len(sole)
    known = SoleCalibration.linear(np.full(n, 0.5), np.full(n, 8.0), 0.125)
    counts = 8.0 + 2.0 * _force(n)
    return [
        _call(
            SoleCalibration.linear,
            gain=Argument(np.full(n, 0.5), ("n",), "gain offset"),
            offset=Argument(np.full(n, 8.0), ("n",), "offset"),
        ),
        _call(known.forces, counts=Argument(np.stack([counts, counts[::-1]]), ("k", n), "counts", nan=True)),
        _call(partial(known.cop_deviation, sole), force=_reading(sole)),
        _call(known.load_deviation, force=_reading(sole)),
        Call(
            "calibration.CountStream.force",
            lambda counts: CountStream(known).force(counts),
            {"counts": Argument(counts, (n,), "counts", nan=True)},
        ),
    ]


def _far(sole: SoleLayout, frames: bool = False) -> Argument:
    n = len(sole)
    value = np.stack([_distance(n), _distance(n)[::-1]]) if frames else _distance(n)
    return Argument(value, (..., n) if frames else (n,), "distance proximit", nan=True)


def _mask(sole: SoleLayout, optional: bool = False) -> Argument:
    return Argument(_force(len(sole)) > 4.0, (len(sole),), "mask taxels faulty", truth=True, optional=optional)


def _arrays_of(sole: SoleLayout) -> dict[str, Argument]:
    n = len(sole)
    return {
        "positions": Argument(sole.positions, (n, 3), "positions"),
        "rotations": Argument(sole.rotations, (n, 3, 3), "rotations"),
        "vertices": Argument(sole.vertices, ("v", 3), "vertices vertex"),
        "areas": Argument(sole.areas, (n,), "areas"),
        "outline": Argument(sole.outline, ("k", 2), "outline", least=3),
        "ids": Argument(sole.ids, (n,), "ids"),
    }


def _layout_with(sole: SoleLayout, arrays: dict[str, Any]) -> SoleLayout:
    known = {"name": sole.name, "side": sole.side, "corners": sole.corners, "neighbours": sole.neighbours}
    return SoleLayout(**(known | arrays))


def _of_mechanics() -> list[Call]:
    whole = Argument(_WRENCH, (..., 6), "wrench", nan=True)
    one = Argument(_WRENCH, (6,), "wrench", nan=True)
    com = Argument(np.array([0.5, 0.25, 1.0]), (..., 3), "com velocity")
    return [
        _call(wrench.wrench_at, wrench=whole, point=Argument(np.array([0.5, 0.25, 1.0]), (3,), "point")),
        *(
            _call(partial(f, mass=50.0, omega=3.5), wrench=whole)
            for f in (external_wrench.vrp_offset, external_wrench.external_acceleration)
        ),
        _call(
            partial(lip.divergent_component, omega=4.0),
            com=Argument(com.value, (...,), "com", nan=True),
            com_velocity=Argument(com.value, (...,), "velocity com", nan=True),
        ),
        _call(zmp.zmp_in_plane, wrench=one),
        _call(zmp.zero_moment_wrench, wrench=one),
        _call(
            zmp.centroidal_moment_pivot,
            force=Argument(_WRENCH[:3], (3,), "force", nan=True),
            com=Argument(com.value, (3,), "com", nan=True),
        ),
        Call(
            "zmp.zmp_of_feet",
            lambda point: zmp.zmp_of_feet([point, None], [64.0, 0.0]),
            {"point": Argument(np.array([0.5, 0.25]), (2,), "point zmp", optional=True)},
        ),
    ]


def _of_readings(sole: SoleLayout) -> list[Call]:
    n = len(sole)
    frames, one = _reading(sole, frames=True), _reading(sole)
    free = Argument(frames.value, (..., "n"), "force value", nan=True)
    anything = Argument(frames.value, (...,), "force value mean reading", nan=True)
    times = Argument(np.arange(2.0), ("f",), "times")
    pressed = np.outer(8.0 + 8.0 * np.sin(np.arange(32.0)), np.ones(n))
    return [
        _call(partial(force.center_of_pressure, sole, threshold=0.0), force=one),
        _call(partial(force.ground_reaction_wrench, sole, threshold=0.0), force=frames),
        _call(partial(activation.active_taxels, threshold=4.0), force=free),
        _call(partial(activation.active_of, sole), force=free),
        _call(partial(activation.hysteresis, high=8.0, low=4.0), values=free),
        Call(
            "activation.TaxelActivation.update",
            lambda force_: activation.TaxelActivation(4.0).update(force_),
            {"force_": Argument(one.value, ("n",), "force", nan=True)},
        ),
        _call(health.dead_taxels, values=anything),
        _call(partial(health.saturated_taxels, highest=8.0), values=anything),
        _call(health.stuck_taxels, times=times, values=Argument(frames.value, ("f", "n"), "values readings", nan=True)),
        Call(
            "health.StuckMonitor.update",
            lambda values: health.StuckMonitor().update(0.0, values),
            {"values": Argument(one.value, ("n",), "values readings", nan=True)},
        ),
        _call(
            partial(health.fill_from_neighbours, sole),
            values=Argument(frames.value, (..., n), "readings", nan=True),
            faulty=_mask(sole),
        ),
        Call(
            "taxel_faults.WornFaults.read",
            lambda force_, vectors: taxel_faults.TaxelFaults(shear=0.5).worn(sole).read(0.0, force_, vectors),
            {"force_": Argument(one.value, (n,), "force"), "vectors": Argument(np.ones((n, 3)), (n, 3), "vectors")},
        ),
        Call(
            "identify_faults.identify_faults",
            lambda time, force_, read: identify_faults.identify_faults(sole, time, force_, read).worn.gains,
            {
                "time": Argument(np.arange(32.0), ("t",), "times frames forces", least=20),
                "force_": Argument(pressed, ("t", n), "forces frames load", least=20),
                "read": Argument(1.25 * pressed, ("t", n), "readings frames dead", nan=True, least=20),
            },
        ),
        _call(partial(clipping.clipped_mean, noise=1.0), force=anything),
        _call(partial(clipping.unclipped_mean, noise=1.0), mean=anything),
        _call(
            force.joint_torque,
            jacobian=Argument(np.arange(12.0).reshape(6, 2), (6, "j"), "jacobian"),
            rotation_to_base=Argument(_TURN, (3, 3), "rotation"),
            wrench=Argument(_WRENCH, (..., 6), "wrench", nan=True),
        ),
        _call(partial(force.pressure_driven_wrench, sole, reference_area=0.015625), force=frames),
        _call(
            partial(force.scaled_by_area, reference_area=0.25),
            wrench=Argument(np.stack([_WRENCH, _WRENCH]), (..., 6), "wrench", nan=True),
            contact_area=Argument(np.array([0.5, 0.25]), ("f",), "area"),
        ),
        Call(
            "reading.Reading",
            lambda **a: Reading(time=0.0, **a),
            {
                "force": Argument(one.value, ("n",), "force reading", nan=True),
                "proximity": Argument(_distance(n), ("n",), "proximity", nan=True, optional=True),
                "temperature": Argument(one.value, ("n",), "temperature", nan=True, optional=True),
                "acceleration": Argument(np.zeros((n, 3)), ("n", 3), "acceleration", nan=True, optional=True),
            },
        ),
    ]


def _of_fields(sole: SoleLayout) -> list[Call]:
    far, free = _far(sole), Argument(_far(sole, frames=True).value, (...,), "distance", nan=True)
    one, warm = (
        _reading(sole, "temperature"),
        Argument(_reading(sole, frames=True).value, (...,), "temperature", nan=True),
    )
    return [
        _call(partial(proximity.near_taxels, threshold=0.02), distance=free),
        _call(partial(proximity.proximity_measure, sensing_range=0.125), distance=free),
        _call(partial(proximity.preemptive_polygon, sole, threshold=0.02), distance=far),
        _call(partial(proximity.height_contours, sole, heights=[0.02, 0.03]), distance=far),
        _call(partial(proximity.cells_polygon, sole), taxels=_mask(sole)),
        _call(partial(ground_plane.fit_ground_plane, sole), distance=far),
        _call(partial(temperature.warm_taxels, threshold=4.0), temperature=warm),
        _call(partial(temperature.temperature_measure, threshold=4.0), temperature=warm),
        _call(partial(temperature.temperature_footprint, sole, threshold=4.0), temperature=one),
        _call(
            partial(temperature.temperature_wrench, sole, threshold=4.0),
            temperature=_reading(sole, "temperature", frames=True),
        ),
    ]


def _of_wrenches(sole: SoleLayout) -> list[Call]:
    n = len(sole)
    touch = {
        "force": Argument(_force(n), ("n",), "force proximity", nan=True),
        "proximity": Argument(_distance(n), ("n",), "force proximity", nan=True),
    }
    pair = {
        "contact": Argument(np.stack([_WRENCH] * 3), ("f", 6), "contact wrench", nan=True),
        "virtual": Argument(np.stack([_WRENCH] * 3), ("f", 6), "virtual wrench", nan=True),
    }
    single = {k: Argument(_WRENCH, (6,), "wrench", nan=True) for k in pair}
    return [
        _call(
            partial(virtual_wrench.virtual_ground_reaction_wrench, sole, gain=50.0), distance=_far(sole, frames=True)
        ),
        _call(
            partial(virtual_wrench.early_stop, threshold=8.0),
            virtual_wrench=Argument(np.stack([_WRENCH] * 2), (..., 6), "wrench", nan=True),
        ),
        Call(
            "virtual_wrench.SoleWrenchSwitch.update",
            lambda contact, virtual: virtual_wrench.SoleWrenchSwitch(32.0).update(contact, virtual),
            single,
        ),
        _call(partial(body_skin.active_cells, force_threshold=4.0, proximity_threshold=0.02), **touch),
        _call(partial(body_skin.patch_signal, weight=0.5), **touch),
        _call(partial(body_skin.pseudo_force, force_weight=1.0, proximity_weight=2.0), **touch),
        _call(
            body_skin.skin_wrench,
            positions=Argument(sole.positions, ("n", 3), "positions"),
            rotations=Argument(sole.rotations, ("n", 3, 3), "rotations"),
            signal=Argument(_force(n), (..., "n"), "signal", nan=True),
        ),
        _of_net_wrench(),
    ]


def _of_net_wrench() -> Call:
    patch = link_skin.SkinPatch("chest", "torso", np.zeros((1, 3)), np.eye(3)[None], np.full(1, 1e-3))
    return _call(
        partial(
            net_wrench.net_wrench,
            skin=link_skin.BodySkin([patch]),
            reading=Reading(0.0, np.full(1, 4.0), np.full(1, np.inf)),
            poses={"torso": (np.zeros(3), np.eye(3))},
            rules=net_wrench.NetWrenchRules(),
        ),
        point=Argument(np.array([0.5, 0.25, 1.0]), (3,), "point"),
    )


def _of_batches(sole: SoleLayout) -> list[Call]:
    n = len(sole)
    frames = Argument(_reading(sole, frames=True).value, (..., n), "force", nan=True)
    far = Argument(_far(sole, frames=True).value, (..., n), "distance", nan=True)
    return [
        _call(partial(batch.loads, sole), force=frames),
        _call(partial(batch.wrenches, sole), force=frames),
        _call(partial(batch.support_polygons, sole, vertices=True), force=frames),
        _call(partial(batch.ground_planes, sole), distance=far),
        _call(
            partial(foot_tick.walking_tick, sole, offset=0.0078125),
            force=_reading(sole),
            aim=Argument(np.array([0.015625, 0.0]), (2,), "aim point", nan=True),
        ),
    ]


def _of_objects(sole: SoleLayout) -> list[Call]:
    n = len(sole)
    active = Argument(_mask(sole).value, (n,), "mask", truth=True, optional=True)
    place = Argument(np.array([1.0, 2.0, 0.5]), (3,), "position sole pose")
    turn = Argument(_TURN, (3, 3), "rotation sole pose")
    pose = sole_pose.SolePose(_TURN, place.value)
    plane_or_space = Argument(_RING, ("k", "2 or 3"), "polygon")
    shape = outline.Outline.of_rings([_RING])
    fit = partial_contact.PartialContact(sole)
    lines = Argument(_LINES, ("m", 3), "lines")
    feet = {"wrench": Argument(_WRENCH, (6,), "wrench", nan=True)}
    given = Reading(time=0.0, force=_force(n))
    return [
        Call(
            "percept.Percept",
            lambda active, stuck: _seen(Percept(sole, given, active=active, stuck=stuck)),
            {"active": active, "stuck": active},
        ),
        _call(sole_pose.SolePose, rotation_sole_to_world=turn, position_in_world=place),
        _call(pose.polygon_to_world, polygon=plane_or_space),
        _call(pose.to_world, points=Argument(np.arange(6.0).reshape(2, 3), (..., 3), "points", nan=True)),
        _call(pose.wrench_to_world, wrench=Argument(_WRENCH, (..., 6), "wrench", nan=True)),
        Call(
            "sole_pose.wrench_of_feet", lambda wrench: sole_pose.wrench_of_feet([wrench, _WRENCH], [pose, pose]), feet
        ),
        _call(
            partial(outline.Outline, starts=[0, 5], ring_areas=shape.ring_areas),
            points=Argument(_RING, (5, 2), "points outline"),
        ),
        Call(
            "outline.Outline.of_rings", lambda ring: outline.Outline.of_rings([_RING, ring]), {"ring": _polygon("ring")}
        ),
        _call(
            shape.moved,
            rotation=Argument(_TURN[:2, :2], (2, 2), "rotation"),
            translation=Argument(np.array([1.0, 2.0]), ("2 or 3",), "translation"),
        ),
        _call(fit.between, supported=_mask(sole), idle=Argument(~_mask(sole).value, (n,), "mask taxels", truth=True)),
        _call(fit.cover, lines=lines),
        _call(fit.polygon, lines=lines),
        Call(
            "partial_contact.PartialContact.expected",
            lambda point, lines: fit.expected(64.0, point, lines),
            {"point": Argument(np.array([0.0, 0.0]), (2,), "center centre point pressure"), "lines": lines},
        ),
        Call(
            "partial_contact.PartialContact.update",
            lambda **a: partial_contact.PartialContact(sole).update(**a),
            {
                "load": _reading(sole, "load"),
                "active": _mask(sole),
                "start": Argument(_LINES, ("m", 3), "lines", optional=True),
            },
        ),
    ]


def _seen(percept: Percept) -> tuple[Any, ...]:
    return percept.wrench_in_sole, percept.contact_area, percept.active
