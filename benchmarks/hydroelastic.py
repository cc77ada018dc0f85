"""Both taxel models against Drake's hydroelastic contact: `python benchmarks/hydroelastic.py`, with the extra `bench`.

A compliant sole, `THICKNESS` thick and of `MODULUS`, is pressed onto rigid ground in random poses. Drake's pressure on
each cell is the truth of that taxel. The models get the simulator's input: contact points of a rigid sole in the same
pose, and the field's force and centre of pressure.
"""

import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import shapely
from numpy.typing import NDArray
from pydrake.common.value import AbstractValue
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddRigidHydroelasticProperties,
    Box,
    FramePoseVector,
    GeometryFrame,
    GeometryInstance,
    HydroelasticContactRepresentation,
    ProximityProperties,
    SceneGraph,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from resumable import write_table

from plantar import load_robot
from plantar.bench.tables import markdown_table
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.rotation import rotation_from_angles
from plantar.sim.model.contact_truth import REACH, foot_contacts
from plantar.sim.sensing.elastic_pressure import ElasticPressure
from plantar.sim.sensing.sole_pressure import SolePressure
from plantar.sim.terrain import Ground, Solid

THICKNESS, MODULUS = 0.012, 6e6
"""Of the sole in m and Pa. Drake's field rises from a box's faces to its middle: 1 GPa/m, as rubber has."""

POSES = 20
SLOPE = rotation_from_angles(0.3, 0.1, -0.08)
SHAPES = {
    "plane": Solid("box", (1.0, 1.0, 0.2), np.array([0.0, 0.0, -0.2])),
    "beam's edge": Solid("box", (0.06, 1.0, 0.2), np.array([0.0, 0.0, -0.2])),
    "block's corner": Solid("box", (0.4, 0.4, 0.2), np.array([0.4, 0.4, -0.2])),
    "sphere": Solid("sphere", (0.03, 0.0, 0.0), np.array([0.0, 0.0, -0.03])),
    "slope": Solid("box", (0.15, 1.0, 0.2), SLOPE @ np.array([0.0, 0.0, -0.2]), SLOPE),
}


class Truth:
    """The sole in Drake over one solid."""

    def __init__(self, center: NDArray[np.float64], half: NDArray[np.float64], solid: Solid) -> None:
        self.graph = SceneGraph()
        source = self.graph.RegisterSource("rig")
        self.frame = self.graph.RegisterFrame(source, GeometryFrame("sole"))
        sole = GeometryInstance(RigidTransform([*center, 0.5 * THICKNESS]), Box(*(2.0 * half), THICKNESS), "sole")
        soft, hard = ProximityProperties(), ProximityProperties()
        AddCompliantHydroelasticProperties(resolution_hint=0.01, hydroelastic_modulus=MODULUS, properties=soft)
        AddRigidHydroelasticProperties(resolution_hint=1e-3, properties=hard)
        sole.set_proximity_properties(soft)
        self.graph.RegisterGeometry(source, self.frame, sole)
        size = np.array(solid.size)
        shape = Box(*(2.0 * size)) if solid.shape == "box" else Sphere(size[0])
        ground = GeometryInstance(RigidTransform(RotationMatrix(solid.rotation), solid.position), shape, "ground")
        ground.set_proximity_properties(hard)
        self.graph.RegisterAnchoredGeometry(source, ground)
        self.context = self.graph.CreateDefaultContext()
        self.port = self.graph.get_source_pose_port(source)

    def pieces(
        self, place: NDArray[np.float64], rotation: NDArray[np.float64]
    ) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Polygons (k, 2) in m of the surface in the sole frame, with their corners' pressures (k,) in Pa."""
        poses = FramePoseVector()
        poses.set_value(self.frame, RigidTransform(RotationMatrix(rotation), place))
        self.port.FixValue(self.context, AbstractValue.Make(poses))
        query: Any = self.graph.get_query_output_port().Eval(self.context)
        found = []
        for surface in query.ComputeContactSurfaces(HydroelasticContactRepresentation.kPolygon):
            mesh, field = surface.poly_mesh_W(), surface.poly_e_MN()
            points = np.array([mesh.vertex(i) for i in range(mesh.num_vertices())])
            values = np.array([field.EvaluateAtVertex(i) for i in range(mesh.num_vertices())])
            local = (points - place) @ rotation
            for i in range(mesh.num_elements()):
                element = mesh.element(i)
                ids = [element.vertex(k) for k in range(element.num_vertices())]
                found.append((local[ids, :2], values[ids]))
        return found


def load_of(pieces: list[tuple[NDArray[np.float64], NDArray[np.float64]]]) -> NDArray[np.float64]:
    """Force in N, and force times place (x, y) in N m, of a pressure field, triangle by triangle."""
    total = np.zeros(3)
    for ring, pressure in pieces:
        part = np.zeros(3)
        for k in range(1, len(ring) - 1):
            corners, p = ring[[0, k, k + 1]], pressure[[0, k, k + 1]]
            (ax, ay), (bx, by) = corners[1] - corners[0], corners[2] - corners[0]
            size = 0.5 * (ax * by - ay * bx)  # negative where a ring bends inwards
            weights = (p + p.sum()) / 12.0  # the integral of a linear field times each corner's share
            part += size * np.array([p.mean(), *(weights @ corners)])
        total += math.copysign(1.0, part[0]) * part
    return total


def on_cells(
    pieces: list[tuple[NDArray[np.float64], NDArray[np.float64]]], layout: SoleLayout
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Force (n,) in N on each cell, and force and moments (3,) of all cells as of `load_of`; no rim."""
    cells = np.array([shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))])
    out, total = np.zeros(len(layout)), np.zeros(3)
    tree = shapely.STRtree(cells)
    for ring, pressure in pieces:
        polygon = shapely.Polygon(ring)
        if polygon.area < 1e-14:
            continue
        field = np.linalg.lstsq(np.column_stack([ring, np.ones(len(ring))]), pressure, rcond=None)[0]
        for cell in tree.query(polygon):
            part = polygon.intersection(cells[cell])
            if part.geom_type != "Polygon" or part.area < 1e-14:
                continue
            corners = np.array(part.exterior.coords)[:-1]
            load = load_of([(corners, np.column_stack([corners, np.ones(len(corners))]) @ field)])
            out[cell] += load[0]
            total += load
    return out, total


class Rigid:
    """The rigid sole in MuJoCo, whose contact points the taxel models get."""

    def __init__(self, center: NDArray[np.float64], half: NDArray[np.float64], solid: Solid) -> None:
        spec = mujoco.MjSpec()
        spec.add_material(name="ground")
        Ground((solid,), -5.0, 0.8).add_to(spec)
        body = spec.worldbody.add_body(name="foot")
        body.add_freejoint()
        size, place = [*half, 0.5 * THICKNESS], [*center, 0.5 * THICKNESS]
        box = mujoco.mjtGeom.mjGEOM_BOX
        body.add_geom(name="sole", type=box, size=size, pos=place, contype=1, conaffinity=2, mass=80.0)
        self.model = spec.compile()
        self.model.geom_gap[:] = 1e-3
        self.data = mujoco.MjData(self.model)
        self.sole = {self.model.geom("sole").id}

    def points(self, place: NDArray[np.float64], rotation: NDArray[np.float64]) -> list[tuple[float, float]]:
        """Contact points (x, y) in m in the sole frame that carry or could."""
        self.data.qpos[:3] = place
        mujoco.mju_mat2Quat(self.data.qpos[3:7], rotation.ravel())
        mujoco.mj_forward(self.model, self.data)
        contacts = foot_contacts(self.model, self.data, self.sole)
        local = (contacts.positions - place) @ rotation
        return [(x, y) for (x, y, _), gap in zip(local.tolist(), contacts.distances, strict=True) if gap <= REACH]


def errors(name: str, layout: SoleLayout, models: dict[str, Any]) -> tuple[dict[str, NDArray[np.float64]], Any]:
    """Errors of each model (poses, 2), centre of pressure in mm and largest of a taxel over the largest force, and an
    example: the true forces and each model's."""
    solid, rng = SHAPES[name], np.random.default_rng(0)
    low, high = layout.outline.min(axis=0), layout.outline.max(axis=0)
    center, half = 0.5 * (low + high), 0.5 * (high - low)
    truth, rigid = Truth(center, half, solid), Rigid(center, half, solid)
    found: dict[str, list[tuple[float, float]]] = {model: [] for model in models}
    example: dict[str, NDArray[np.float64]] = {}
    while len(found["springs"]) < POSES:
        yaw, size = rng.uniform(-math.pi, math.pi), 10.0 ** rng.uniform(-6.0, -3.6)
        tilt = rotation_from_angles(0.0, *rng.normal(0.0, size, 2))
        rotation = solid.rotation @ tilt @ rotation_from_angles(yaw)
        offset = rotation @ np.array([*(rng.uniform(-0.7, 0.7, 2) * half - center), 0.0])
        force, low_z, high_z = rng.uniform(200.0, 900.0), -6e-3, 1e-3
        for _ in range(22):
            height = 0.5 * (low_z + high_z)
            place = offset + height * solid.rotation[:, 2]
            if load_of(truth.pieces(place, rotation))[0] > force:
                low_z = height
            else:
                high_z = height
        pieces = truth.pieces(place, rotation)
        points = rigid.points(place, rotation)
        true, load = on_cells(pieces, layout)
        if load[0] < 100.0 or not points:
            continue
        middle = true @ layout.positions[:, :2] / true.sum()
        for model, pressure in models.items():
            given = pressure.spread(points, float(load[0]), tuple((load[1:] / load[0]).tolist()))
            off = math.dist(given @ layout.positions[:, :2] / given.sum(), middle)
            found[model].append((1e3 * off, float(np.abs(given - true).max() / true.max())))
            example[model] = given
        example["Drake"] = true
    return {model: np.array(rows) for model, rows in found.items()}, example


def draw(layout: SoleLayout, examples: dict[str, dict[str, NDArray[np.float64]]]) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

    columns = ("Drake", *(model for model in next(iter(examples.values())) if model != "Drake"))
    figure = Figure(figsize=(2.6 * len(columns), 1.9 * len(examples)), layout="constrained")
    for row, (shape, forces) in enumerate(examples.items()):
        largest = float(forces["Drake"].max())
        for column, name in enumerate(columns):
            axes = figure.add_subplot(len(examples), len(columns), row * len(columns) + column + 1)
            cells = PolyCollection([layout.cell_polygon(i) for i in range(len(layout))], cmap="viridis", lw=0.3)
            cells.set_array(forces[name])
            cells.set_clim(0.0, largest)
            axes.add_collection(cells)
            axes.autoscale_view()
            axes.set_aspect("equal")
            axes.set_xticks([])
            axes.set_yticks([])
            axes.set_title(f"{shape}: {name}, up to {forces[name].max():.0f} N", fontsize=7)
    figure.savefig(Path(__file__).with_name("hydroelastic.png"), dpi=110)


if __name__ == "__main__":
    layout = load_robot("h1").layouts["left"]
    models: dict[str, Any] = {
        "springs": SolePressure(layout),
        "elastic layer": ElasticPressure(layout, thickness=THICKNESS),
    }
    lines, examples = [], {}
    for shape in SHAPES:
        rows, examples[shape] = errors(shape, layout, models)
        for model, error in rows.items():
            (a, c), (b, d) = np.median(error, axis=0), error.max(axis=0)
            lines.append((shape, model, f"{a:.2f}", f"{b:.2f}", f"{100 * c:.1f} %", f"{100 * d:.1f} %"))
            print(*lines[-1], flush=True)
    head = ("ground", "taxels", "CoP error, median [mm]", "largest [mm]", "taxel error, median", "largest")
    write_table(Path(__file__).with_name("hydroelastic.md"), [markdown_table(head, lines)])
    draw(layout, examples)
