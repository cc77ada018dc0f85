"""Bodies of a robot's model: shapes, places, mass; only needed parts are compiled."""

import math
import warnings
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import check_input
from plantar.common.files.model_source import BELOW, LEAST, read_model_source
from plantar.errors import FootError
from plantar.mujoco.deletion import delete_all
from plantar.mujoco.mesh_surface import mesh_surface
from plantar.shoes.foot.mesh_file import MOST_TRIANGLES, read_mesh
from plantar.shoes.geometry.surface import primitive

_LARGEST = 100e6  # bytes of a mesh
FARTHEST = 1e6  # distance in m beyond which no shape reaches

_UNLIMITED = 0.6  # rad to either side of a joint without limits
# radii of gyration from a center of mass to a link's farthest point: up to 2.92 of 88 links of legs of nine models
_REACH = 3.0
_READ_BY_MUJOCO = (".stl", ".obj", ".msh")
_NOT_NEEDED: tuple[str, ...] = (
    *("keys", "sensors", "actuators", "tendons", "equalities", "pairs", "excludes", "tuples", "skins", "flexes"),
    "textures",
)
# groups of geoms
_COLLIDING = 0
_DRAWN = 1
_ELSEWHERE = 2

Array = NDArray[np.float64]
# Gives the rotation (3, 3) and place (3,) of shapes for angles of joints
Poses = Callable[[Iterable[float]], list[tuple[Array, Array]]]


class UnreadLink(NamedTuple):
    """A body whose mesh cannot be read: its name, why, and the distance in m from its center of mass within which its
    shape stays, by its mass and inertia; infinite where the model states none.
    """

    name: str
    problem: str
    reach: float


class LinksAbove(NamedTuple):
    """Links above a foot.

    `surfaces`: triangles (n, 3, 3) in m of each shape; `ranges`: of the last two hinges above, in rad; `poses`: from
    their angles to each shape's rotation (3, 3) and place (3,), body frame at the zero pose, then to those of the
    centers of mass of what is `unread`.
    """

    surfaces: list[Array]
    ranges: list[tuple[float, float]]
    poses: Poses
    unread: tuple[UnreadLink, ...]


class _NotCompiled(FootError):
    """Model that MuJoCo cannot compile, possibly for an unreadable mesh kind."""


class BodyPlace(NamedTuple):
    """Body in the zero pose.

    `shaped`: whether it, or what is fixed to it, has a shape; `carries`: whether a moving body hangs on it; `depth`:
    bodies above it; `position`: origin (3,) in the model's world in m; `rotation` (3, 3): from its frame to that world.
    """

    shaped: bool
    carries: bool
    depth: int
    position: Array
    rotation: Array


class ModelBodies:
    """Bodies of a robot's model: places, shapes, mass. What is not asked for is not compiled."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self._source = read_model_source(file, FootError)
        self._read: dict[Path, Array] = {}

    def _spec(self) -> Any:
        """Editable model, without what lacks mass and shape."""
        spec = self._source.spec()
        import mujoco

        flat = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)
        delete_all(spec, [*(geom for geom in spec.geoms if geom.type in flat), *spec.hfields])
        for material in spec.materials:
            material.textures = [""] * len(material.textures)
        for part in _NOT_NEEDED:
            delete_all(spec, getattr(spec, part, ()))
        for compiler in (spec.compiler, *(body.compiler for body in spec.bodies)):
            compiler.balanceinertia = True
            compiler.boundmass = max(compiler.boundmass, LEAST)
            compiler.boundinertia = max(compiler.boundinertia, LEAST)
        return spec

    def bodies(self) -> dict[str, BodyPlace]:
        """All robot bodies by name."""
        spec = self._spec()
        parts = {body.name: list(_fixed_to(body)) for body in spec.bodies[1:]}
        shaped = {name: any(len(b.geoms) for b in part) for name, part in parts.items()}
        carries = {name: any(child.joints for b in part for child in b.bodies) for name, part in parts.items()}
        delete_all(spec, [g for g in spec.geoms if g.meshname])
        self._give_meshes(spec, read_all=False)
        model, data = self._placed(spec)
        depth = np.zeros(model.nbody, dtype=int)
        for i in range(1, model.nbody):
            depth[i] = depth[model.body_parentid[i]] + 1
        names = {i: model.body(i).name for i in range(1, model.nbody)}
        return {
            name: BodyPlace(
                shaped[name], carries[name], int(depth[i]), data.xpos[i].copy(), data.xmat[i].reshape(3, 3).copy()
            )
            for i, name in names.items()
            if name in parts and name != BELOW
        }

    def shapes(self, name: str, most: int) -> tuple[list[Array], list[Array]]:
        """Gives drawn and colliding surfaces of the body of a name and what is fixed to it, most in number: triangles
        (n, 3, 3) in m about its origin, turned as in the zero pose.
        """
        try:
            return self._shapes(name, most, read_all=False)
        except _NotCompiled:  # MuJoCo reads no text STL and none of more than 200,000 triangles
            return self._shapes(name, most, read_all=True)

    def mass(self, name: str) -> tuple[float | None, str]:
        """Mass in kg of a body's robot, None if unknown; and a note."""
        model = None
        problem = ""
        for read_all in (False, True):
            try:
                spec = self._spec()
                stated = [body for body in spec.bodies if not _weighed_by_shapes(body)]
                delete_all(spec, [g for body in stated for g in body.geoms if g.meshname])
                self._give_meshes(spec, read_all)
                model = self._placed(spec)[0]
                break
            except FootError as error:
                problem = str(error).removeprefix(f"{self.file}: ")
        if model is None:
            return None, f"the robot's mass is not read: {problem[:120]}"
        body = model.body(name).id
        while model.body(model.body_parentid[body]).name not in ("world", BELOW):
            body = int(model.body_parentid[body])
        mass = float(model.body_subtreemass[body])
        known = (
            stated or not self._source.is_urdf
        )  # of a URDF, what collides weighs as water, and what is drawn nothing
        if not (known and math.isfinite(mass) and mass > model.nbody * 2.0 * LEAST):
            return None, "the robot's model states no mass"
        return mass, f"the robot's mass is {mass:.4g} kg, of its model"

    def _shapes(self, name: str, most: int, *, read_all: bool) -> tuple[list[Array], list[Array]]:
        import mujoco

        spec = self._spec()
        for geom in spec.geoms:
            geom.group = _ELSEWHERE
        part = [geom for body in _fixed_to(spec.body(name)) for geom in body.geoms]
        for geom in part:
            geom.group = _COLLIDING if _collides(geom) else _DRAWN
            # no convex hull of a mesh is needed then
            geom.contype = 0
            geom.conaffinity = 0
        delete_all(spec, [geom for geom in spec.geoms if geom.group == _ELSEWHERE])
        if len(part) > most:
            raise FootError(f"{self.file}: body '{name}' has {len(part)} shapes; allowed: up to {most}")
        self._give_meshes(spec, read_all)
        fitted = {
            g.meshname
            for g in spec.geoms
            if g.meshname and g.type not in (mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF)
        }
        for mesh in [m for m in spec.meshes if m.name not in fitted]:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL  # is there for open and flat surfaces, too
        model, data = self._placed(spec)
        self._few_enough(model, name)
        origin = data.xpos[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)]
        drawn: list[Array] = []
        colliding: list[Array] = []
        for g in range(model.ngeom):
            local = _surface(model, g, f"{self.file}: <geom name='{model.geom(g).name}'>")
            turn = data.geom_xmat[g].reshape(3, 3)
            (drawn if model.geom_group[g] == _DRAWN else colliding).append(local @ turn.T + data.geom_xpos[g] - origin)
        return drawn, colliding

    def links_above(self, name: str, count: int) -> LinksAbove:
        """The links above the foot of a name, count of them, and its toes, and how the ankle moves them."""
        try:
            return self._links_above(name, count, read_all=False)
        except _NotCompiled:
            return self._links_above(name, count, read_all=True)

    def _links_above(self, name: str, count: int, *, read_all: bool) -> LinksAbove:
        import mujoco

        spec = self._spec()
        own = {body.name for body in _fixed_to(spec.body(name))}
        kept = {body.name for body in spec.body(name).find_all("body")}
        link = _moving(spec.body(name))
        for _ in range(count + 1):
            kept |= {body.name for body in _fixed_to(link)}
            if link.parent is None or link.parent.name == "world":
                break
            link = _moving(link.parent)
        delete_all(spec, [g for g in spec.geoms if g.parent.name not in kept - own])
        problems = self._mesh_problems(spec, read_all)
        lost = [g for g in spec.geoms if g.meshname in problems]
        unread = {g.parent.name: problems[g.meshname] for g in lost}
        colliding = {g.parent.name for g in lost if _collides(g)}
        delete_all(spec, lost)
        # What collides stands in for what is drawn and cannot be read.
        replaced = {g.parent.name for g in spec.geoms if _collides(g)} - colliding
        drawn = {g.parent.name for g in spec.geoms if not _collides(g)} - set(unread)
        delete_all(spec, [g for g in spec.geoms if g.parent.name in drawn and _collides(g)])
        unread = {body: why for body, why in unread.items() if body not in replaced}
        weighed = {body: _weighed(spec.body(body)) for body in unread}
        for geom in spec.geoms:
            geom.contype = 0
            geom.conaffinity = 0
        self._give_meshes(spec, read_all)
        for mesh in spec.meshes:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        model, data = self._placed(spec)
        foot = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        joints = _hinges_above(model, foot)
        start = data.xmat[foot].reshape(3, 3).copy()
        centers = [model.body(weighed[body] or body).id for body in unread]

        def poses(angles: Iterable[float]) -> list[tuple[Array, Array]]:
            data.qpos[model.jnt_qposadr[joints]] = list(angles)
            mujoco.mj_kinematics(model, data)
            turn = start @ data.xmat[foot].reshape(3, 3).T
            places = [(data.geom_xmat[g], data.geom_xpos[g]) for g in range(model.ngeom)]
            places += [(data.ximat[body], data.xipos[body]) for body in centers]
            return [(turn @ own.reshape(3, 3), turn @ (place - data.xpos[foot])) for own, place in places]

        ranges = [
            (low, high) if model.jnt_limited[j] and low < high < low + math.tau else (-_UNLIMITED, _UNLIMITED)
            for j, (low, high) in zip(joints, model.jnt_range[joints].tolist(), strict=True)
        ]
        surfaces = [_surface(model, g, str(self.file)) for g in range(model.ngeom)]
        without = tuple(
            UnreadLink(body, why, _reach(model, center) if weighed[body] else math.inf)
            for (body, why), center in zip(unread.items(), centers, strict=True)
        )
        return LinksAbove(surfaces, ranges, poses, without)

    def _mesh_problems(self, spec: Any, read_all: bool) -> dict[str, str]:
        """Why meshes that are used cannot be read, by name."""
        used = {g.meshname for g in spec.geoms if g.meshname}
        problems = {}
        for mesh in spec.meshes:
            if mesh.name in used and mesh.file:
                try:
                    self._check_mesh(self._source.mesh_path(spec, mesh), read_all)
                except FootError as error:
                    problems[mesh.name] = str(error)
        return problems

    def _few_enough(self, model: Any, name: str) -> None:
        """Refuse too many triangles before making them: meshes may be reused many times."""
        drawn = model.geom_group == _DRAWN
        meshes = model.geom_dataid[drawn if drawn.any() else slice(None)]
        count = int(model.mesh_facenum[meshes[meshes >= 0]].sum())
        if count > MOST_TRIANGLES:
            raise FootError(
                f"{self.file}: body '{name}' has {count} triangles; allowed: up to {MOST_TRIANGLES}; reduce its meshes"
            )

    def _give_meshes(self, spec: Any, read_all: bool) -> None:
        """Remove unused meshes; give MuJoCo those it cannot read."""
        used = {g.meshname for g in spec.geoms if g.meshname}
        for mesh in list(spec.meshes):
            if mesh.name not in used:
                spec.delete(mesh)
                continue
            if not mesh.file:
                continue
            path = self._source.mesh_path(spec, mesh)
            triangles = self._check_mesh(path, read_all)
            if triangles is None:
                mesh.file = str(path.resolve())
            else:
                mesh.file = ""
                mesh.uservert = triangles.ravel()
                mesh.userface = np.arange(3 * len(triangles), dtype=np.int32)
        spec.strippath = False  # as it is for a URDF, the folders found here would be left out

    def _check_mesh(self, path: Path, read_all: bool) -> Array | None:
        """Triangles (n, 3, 3) of a mesh that MuJoCo does not read itself; FootError where it cannot be read."""
        kind = path.suffix.lower()
        if kind == ".msh" or (kind in _READ_BY_MUJOCO and not read_all):
            check_input(path, FootError, _LARGEST)
            return None
        if path not in self._read:
            self._read[path] = read_mesh(path)[0]
        return self._read[path]

    def _placed(self, spec: Any) -> tuple[Any, Any]:
        import mujoco

        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)  # of settings that MuJoCo will drop
                model = spec.compile()
        except Exception as error:  # MuJoCo raises ValueError and its own
            raise _NotCompiled(
                f"{self.file}: cannot be read as a robot's model: {' '.join(str(error).split())}"
            ) from None
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        return model, data


def _fixed_to(body: Any) -> Iterator[Any]:
    yield body
    for child in body.bodies:
        if not child.joints:
            yield from _fixed_to(child)


def _hinges_above(model: Any, body: int) -> list[int]:
    import mujoco

    joints: list[int] = []
    while body > 0 and len(joints) < 2:
        first = int(model.body_jntadr[body])
        count = int(model.body_jntnum[body])
        joints += [j for j in range(first, first + count) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE][::-1]
        body = int(model.body_parentid[body])
    return joints[:2]


def _moving(body: Any) -> Any:
    while not body.joints and body.parent is not None and body.parent.name != "world":
        body = body.parent
    return body


def _collides(geom: Any) -> bool:
    return bool(geom.contype or geom.conaffinity)


def _weighed(body: Any) -> str:
    """Name of the body of a link whose stated inertia holds a body of it; empty where none is stated."""
    while _weighed_by_shapes(body) or not body.explicitinertial:
        if body.joints or body.parent is None or body.parent.name == "world":
            return ""
        body = body.parent
    return str(body.name)


def _reach(model: Any, body: int) -> float:
    mass = float(model.body_mass[body])
    if not mass > 2.0 * LEAST:
        return math.inf
    return _REACH * math.sqrt(0.5 * float(model.body_inertia[body].sum()) / mass)


def _weighed_by_shapes(body: Any) -> bool:
    import mujoco

    kind = mujoco.mjtInertiaFromGeom
    chosen = int(body.compiler.inertiafromgeom)
    return chosen == int(kind.mjINERTIAFROMGEOM_TRUE) or (
        chosen == int(kind.mjINERTIAFROMGEOM_AUTO) and not body.explicitinertial
    )


def _surface(model: Any, geom: int, where: str) -> Array:
    import mujoco

    kind = mujoco.mjtGeom(int(model.geom_type[geom]))
    if not (np.abs(model.geom_size[geom]) < FARTHEST).all():
        raise FootError(f"{where} reaches farther than {FARTHEST:g} m")
    if kind in (mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF):
        corners, faces = mesh_surface(model, int(model.geom_dataid[geom]))
        return corners[faces]
    return primitive(kind.name.removeprefix("mjGEOM_").lower(), model.geom_size[geom], where)
