"""Clearance of a built shoe from a robot's other links, over the whole range of the two joints above the foot.

Independent of the plan, which keeps straps and walls off sampled points of links in sampled poses: MuJoCo moves the
links, the bodies are those of the STEP assembly, and a branch and bound over both angles finds the smallest
distance: where a joint turns by d, a point of a link moves by at most d times its distance from the joint's axis, so
that a box of angles in which no point can come nearer than the best one is left out. Lengths in mm.
"""

import heapq
import itertools
import math
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, map_coordinates
from scipy.spatial import KDTree

from plantar.common.files.model_source import read_model_source
from plantar.errors import FootError
from plantar.layouts.source_pose import SourcePose
from plantar.mujoco.deletion import delete_all
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.checks.printability import BOARD_UP
from plantar.shoes.foot.mesh_file import read_mesh
from plantar.shoes.geometry.surface import primitive
from plantar.shoes.papers.step_assembly import assembly_parts
from plantar.shoes.plan.block import Block, Step
from plantar.shoes.solid.kernel import build_solid

FAR = 6.0
"""mm: distances beyond are not told apart."""

_SAMPLES = 1.0  # mm between points on links and bodies
_MARGIN = 20.0  # mm of the field around the bodies
_COARSE = 6.0  # mm between points by which links that stay far are left out
_GRID = 1.0  # mm between nodes of the field of distances
_ENOUGH = 0.2  # mm: to within which the smallest distance is found, about the error of the field between its nodes
_BEST = 4  # poses whose distance is computed exactly
_UNLIMITED = math.pi / 4.0  # rad each way of a joint without a stated range

Array = NDArray[np.float64]


class Clearance(NamedTuple):
    """Smallest distance in mm of a body of the shoe from a link, the two joints' angles there in degrees, and names of
    links whose meshes are not there; `gap` is that of the print from the foot: near zero where the pose is right.
    """

    distance: float
    body: str
    link: str
    angles: tuple[float, ...]
    missing: tuple[str, ...]
    gap: float


class Robot:
    """A model with all its meshes, drawn ones where a link has any, and the hinges above a foot.

    `links`: triangles (n, 3, 3) in mm by body in the body's frame, of all that the foot hangs on, and of toes that hang
    on it; `foot`: the foot's own.
    """

    def __init__(self, file: Path, foot: str) -> None:
        source = read_model_source(file, FootError)
        spec = source.spec()
        missing = _give_meshes(source, spec)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._body = self.model.body(foot).id
        self.hinges = self._hinges()
        own = self.model.body_weldid
        above = {own[body] for body in self._chain(self._body)}
        self.foot = np.empty((0, 3, 3))
        self.links: dict[int, Array] = {}
        for body in range(1, self.model.nbody):
            found = self._surface(body)
            if len(found) and own[body] == own[self._body]:
                mujoco.mj_kinematics(self.model, self.data)
                self.foot = np.concatenate([self.foot, self._moved(found, body)])
            elif len(found) and (own[body] in above or self._body in self._chain(body)):
                self.links[body] = found
        self.missing = tuple(sorted(set(missing.values())))

    def pose(self, angles: tuple[float, ...], body: int) -> tuple[Array, Array]:
        """Rotation (3, 3) and place (3,) in mm of a body in the foot's frame, at the hinges' angles in rad."""
        self.data.qpos[self.model.jnt_qposadr[self.hinges]] = angles
        mujoco.mj_kinematics(self.model, self.data)
        turn = self.data.xmat[self._body].reshape(3, 3).T
        place = turn @ (self.data.xpos[body] - self.data.xpos[self._body])
        return turn @ self.data.xmat[body].reshape(3, 3), 1e3 * place

    def radii(self, points: Array, body: int, angles: tuple[float, ...]) -> Array:
        """How far points (n, 3) of a body move in mm for each rad of each hinge, at most: (n, hinges)."""
        turn, place = self.pose(angles, body)
        world = 1e-3 * (points @ turn.T + place) @ self.data.xmat[self._body].reshape(3, 3).T
        world += self.data.xpos[self._body]
        anchors = self.data.xanchor[self.hinges]
        # An inner hinge's axis is moved by the outer ones: a point's distance from it changes with them by no more than
        # the distance between their anchors.
        offset = max((math.dist(a, b) for a, b in itertools.combinations(anchors, 2)), default=0.0)
        above = self._chain(body)
        moves = [float(self.model.jnt_bodyid[hinge] not in above) for hinge in self.hinges]
        return np.column_stack(
            [m * 1e3 * (np.linalg.norm(world - a, axis=1) + offset) for m, a in zip(moves, anchors, strict=True)]
        )

    def ranges(self) -> list[tuple[float, float]]:
        """Of each hinge, in rad."""
        limited = self.model.jnt_limited[self.hinges]
        return [
            (low, high) if yes and low < high else (-_UNLIMITED, _UNLIMITED)
            for yes, (low, high) in zip(limited, self.model.jnt_range[self.hinges].tolist(), strict=True)
        ]

    def _chain(self, body: int) -> set[int]:
        """A body and all that it hangs on."""
        found = set()
        while body > 0:
            found.add(body)
            body = self.model.body_parentid[body]
        return found

    def _hinges(self) -> list[int]:
        found: list[int] = []
        body = self._body
        while body > 0 and len(found) < 2:
            first = self.model.body_jntadr[body]
            for joint in range(first + self.model.body_jntnum[body] - 1, first - 1, -1):
                if self.model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
                    found.append(joint)
            body = self.model.body_parentid[body]
        return found[:2]

    def _moved(self, triangles: Array, body: int) -> Array:
        turn, place = self.pose(tuple(self.data.qpos[self.model.jnt_qposadr[self.hinges]]), body)
        return triangles @ turn.T + place

    def _surface(self, body: int) -> Array:
        """Triangles of a body's geoms in its frame, what is drawn where it has any, else what collides."""
        own = [g for g in range(self.model.ngeom) if self.model.geom_bodyid[g] == body]
        drawn = [g for g in own if not (self.model.geom_contype[g] or self.model.geom_conaffinity[g])]
        parts = [np.empty((0, 3, 3))]
        for geom in drawn or own:
            turn = np.empty(9)
            mujoco.mju_quat2Mat(turn, self.model.geom_quat[geom])
            parts.append(1e3 * (self._geom(geom) @ turn.reshape(3, 3).T + self.model.geom_pos[geom]))
        return np.concatenate(parts)

    def _geom(self, geom: int) -> Array:
        model = self.model
        mesh = model.geom_dataid[geom]
        kind = mujoco.mjtGeom(int(model.geom_type[geom]))
        if kind == mujoco.mjtGeom.mjGEOM_MESH:
            corner = slice(model.mesh_vertadr[mesh], model.mesh_vertadr[mesh] + model.mesh_vertnum[mesh])
            face = slice(model.mesh_faceadr[mesh], model.mesh_faceadr[mesh] + model.mesh_facenum[mesh])
            return np.asarray(model.mesh_vert[corner][model.mesh_face[face]], dtype=np.float64)
        return primitive(kind.name.removeprefix("mjGEOM_").lower(), model.geom_size[geom], f"geom {geom}")


def _give_meshes(source: Any, spec: Any) -> dict[str, str]:
    """Meshes as they are read here, by file; returns the link of each one that cannot be read, by mesh."""
    missing: dict[str, str] = {}
    used = {geom.meshname: geom.parent.name for geom in spec.geoms if geom.meshname}
    found: dict[str, Array] = {}
    for mesh in spec.meshes:
        if mesh.name in used and mesh.file:
            try:
                found[mesh.name] = read_mesh(source.mesh_path(spec, mesh))[0]
            except FootError:
                missing[mesh.name] = used[mesh.name]
    flat = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)
    delete_all(spec, [*(geom for geom in spec.geoms if geom.type in flat or geom.meshname in missing), *spec.hfields])
    delete_all(spec, [mesh for mesh in spec.meshes if mesh.name in missing or mesh.name not in used])
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    delete_all(spec, spec.textures)
    for mesh in spec.meshes:
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        if mesh.name in found:
            triangles = found[mesh.name]
            mesh.file = ""
            mesh.uservert = triangles.ravel()
            mesh.userface = np.arange(3 * len(triangles), dtype=np.int32)
    return missing


def bodies_of(shoe: Shoe, build: ShoeBuild) -> dict[str, Array]:
    """Triangles (n, 3, 3) of what straps, walls and cable are, in mm in the sole frame: print, straps, board of the
    assembly, and the cable's way from the hole in the sole to the board's upper edge.
    """
    found = {part.name: part.body.surface for part in assembly_parts(shoe, build)}
    kept = {
        "print" if name.endswith(f"{build.kind} {shoe.side}") else name: surface
        for name, surface in found.items()
        if not name.startswith(("taxel", "cell", "sheet", "pad"))
    }
    p = build.parameters
    heel = shoe.plan.heel
    half = 0.5 * p.channel_width
    way = heel.placed(shapely.box(-p.board_gap, -half, 0.0, half))
    rise = p.thickness + BOARD_UP if heel.board else p.rim_top
    kept["cable"] = build_solid([Step("add", "cable", (Block(way, p.bottom, rise),))]).surface
    return kept


def clearance(robot: Robot, bodies: dict[str, Array], pose: SourcePose) -> Clearance:
    """Smallest distance of bodies (triangles in mm in the sole frame) from a robot's links; `pose` of the sole's frame
    in the foot's, of the layout.
    """
    placed = {name: surface @ pose.rotation.T + 1e3 * pose.position for name, surface in bodies.items()}
    shoe = _Surfaces(placed)
    field = _Field(shoe.points)
    gap = float(KDTree(_points(placed["print"])[0]).query(_points(robot.foot)[0])[0].min())
    best = Clearance(FAR, "", "", (), robot.missing, gap)
    for body, triangles in robot.links.items():
        coarse, _ = _points(triangles, _COARSE)
        if not _nearest(robot, body, coarse, field, best.distance + _COARSE):
            continue
        points, owners = _points(triangles)
        for angles in _nearest(robot, body, points, field, best.distance):
            turn, place = robot.pose(angles, body)
            exact, part = shoe.distance(points @ turn.T + place, owners @ turn.T + place)
            if exact < best.distance:
                shown = tuple(round(math.degrees(angle), 1) for angle in angles)
                best = Clearance(exact, part, robot.model.body(body).name, shown, robot.missing, gap)
    return best


class _Field:
    """Distance from points (n, 3) at the nodes of a grid, linear between them; beyond FAR a lower bound."""

    def __init__(self, points: Array) -> None:
        self._box = points.min(axis=0), points.max(axis=0)
        self._low = self._box[0] - _MARGIN
        count = np.ceil((np.ptp(points, axis=0) + 2.0 * _MARGIN) / _GRID).astype(int) + 1
        free = np.ones(count, dtype=bool)
        free[tuple(np.rint((points - self._low) / _GRID).astype(int).T)] = False
        # A point lies up to half a cell's diagonal from its node, and a node's distance is to another's node.
        self._values = np.maximum(distance_transform_edt(free) * _GRID - math.sqrt(3.0) * _GRID, 0.0)
        near = np.argwhere(self._values < FAR)
        found = KDTree(points).query(self._low + _GRID * near, distance_upper_bound=2.0 * FAR)[0]
        self._values[tuple(near.T)] = found

    def beyond(self, points: Array) -> Array:
        """Lower bound (n,) of the distance of points (n, 3) anywhere: from the box around all."""
        outside = np.maximum(np.maximum(self._box[0] - points, points - self._box[1]), 0.0)
        return np.asarray(np.linalg.norm(outside, axis=1))

    def at(self, points: Array) -> Array:
        """Distance (n,) of points (n, 3)."""
        place = (points - self._low) / _GRID
        return np.asarray(map_coordinates(self._values, place.T, order=1, mode="nearest"))


class _Surfaces:
    """Bodies' triangles by name, and points on them."""

    def __init__(self, bodies: dict[str, Array]) -> None:
        sampled = {name: _points(surface) for name, surface in bodies.items()}
        self.points = np.concatenate([points for points, _ in sampled.values()])
        self._triangles = np.concatenate([owners for _, owners in sampled.values()])
        self._names = np.repeat(list(sampled), [len(points) for points, _ in sampled.values()])
        self._tree = KDTree(self.points)

    def distance(self, points: Array, triangles: Array) -> tuple[float, str]:
        """Smallest distance from a link, by points (n, 3) on it and the triangle (n, 3, 3) of each; and the body:
        points of each on triangles of the other.
        """
        rough = self._tree.query(points, distance_upper_bound=2.0 * FAR)[0]
        reach = float(rough.min()) + _SAMPLES
        if not math.isfinite(reach):
            return math.inf, ""
        best = (math.inf, "")
        for k in np.flatnonzero(rough <= reach):
            beside = np.array(self._tree.query_ball_point(points[k], reach))
            on_body = _distances(np.broadcast_to(points[k], (len(beside), 3)), self._triangles[beside])
            on_link = _distances(self.points[beside], np.broadcast_to(triangles[k], (len(beside), 3, 3)))
            found = np.minimum(on_body, on_link)
            least = int(found.argmin())
            best = min(best, (float(found[least]), str(self._names[beside[least]])))
        return best


def _distances(points: Array, triangles: Array) -> Array:
    """Of each point (n, 3) from its triangle (n, 3, 3)."""
    return np.linalg.norm(trimesh.triangles.closest_point(triangles, points) - points, axis=1)


def _points(triangles: Array, spacing: float = _SAMPLES) -> tuple[Array, Array]:
    """Points (n, 3) on triangles, no farther than a spacing apart, corners and edges included; the triangle of each."""
    points = [np.empty((0, 3))]
    owners = [np.empty(0, dtype=np.int64)]
    counts = np.ceil(np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1) / spacing)
    for count in np.unique(counts).astype(int).tolist():
        n = max(count, 1)
        own = np.flatnonzero(counts == count)
        i, j = (index.ravel() for index in np.meshgrid(np.arange(n + 1), np.arange(n + 1)))
        weights = np.column_stack([i, j, n - i - j])[i + j <= n] / n
        points.append(np.einsum("wk,nkd->nwd", weights, triangles[own]).reshape(-1, 3))
        owners.append(np.repeat(own, len(weights)))
    found = np.concatenate(points)
    if not len(found):
        return found, np.empty((0, 3, 3))
    cells = np.rint((found - found.min(axis=0)) / (0.5 * spacing)).astype(np.int64)
    kept = np.unique(cells @ np.array([1, 1 << 20, 1 << 40]), return_index=True)[1]
    return found[kept], triangles[np.concatenate(owners)[kept]]


def _whole(robot: Robot) -> tuple[tuple[float, ...], Array]:
    """Middle and half of the hinges' ranges."""
    ranges = robot.ranges()
    return tuple(0.5 * (low + high) for low, high in ranges), np.array([0.5 * (high - low) for low, high in ranges])


def _nearest(robot: Robot, body: int, points: Array, field: _Field, most: float) -> list[tuple[float, ...]]:
    """Angles at which points of a link come nearest, the best few, where nearer than `most`."""
    middle, halves = _whole(robot)
    radii = robot.radii(points, body, middle)
    limit = most
    best: list[tuple[float, tuple[float, ...]]] = []

    def bounds(angles: tuple[float, ...], halves: Array, kept: Any) -> tuple[float, float, Any]:
        """Lower bound over a box of angles, distance at its middle, and which points may come nearer than `limit`."""
        turn, place = robot.pose(angles, body)
        at = points[kept] @ turn.T + place
        here = np.maximum(field.at(at), field.beyond(at))
        lower = here - radii[kept] @ halves
        return float(lower.min(initial=FAR)), float(here.min(initial=FAR)), kept[lower < limit]

    heap = [(-math.inf, 0, middle, halves, np.arange(len(points)))]
    number = itertools.count(1)
    while heap:
        lower, _, angles, halves, kept = heapq.heappop(heap)
        if lower >= limit - _ENOUGH or limit < _ENOUGH:
            break  # the lowest of all boxes, or they touch
        axis = int(np.argmax(halves * radii[kept].mean(axis=0)))
        smaller = halves.copy()
        smaller[axis] *= 0.5
        for sign in (-1.0, 1.0):
            moved = list(angles)
            moved[axis] += sign * smaller[axis]
            lower, here, near = bounds(tuple(moved), smaller, kept)
            if here < limit:
                limit = here
            if here < min(most, limit + _ENOUGH):
                best.append((here, tuple(moved)))
            if lower < limit - _ENOUGH and len(near):
                heapq.heappush(heap, (lower, next(number), tuple(moved), smaller, near))
    return [angles for _, angles in sorted(best)[:_BEST]]
