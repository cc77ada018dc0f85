"""Patches of skin on public robots against an independent count of what touches them.

    python benchmarks/skin_touches.py PATH...           these models, and all below these folders
    python benchmarks/skin_touches.py PATH... --bodies 4 --output my_page.md

A folder may be that of unpacked wheels with robot models, as those of robosuite, robosuite-models, gymnasium-robotics
and dm-control, or a clone of a repository of models. On each model some bodies get three patches: one by a drawn
direction, one round a drawn axis, one in half of the body. A sphere, a mesh, a slab and a height field press on the
body from drawn directions, one at a time. The count takes forces from `mj_contactForce`, faces from boxes, cylinders
and hulls of the meshes' corners, and shares of cells from the definition in docs/skin.md by SciPy's root finder: it
shares no code with the skin. A touch whose face or place is on the border of a patch to 1e-6 is counted as such, and
not compared.

With MuJoCo Warp (`pip install '.[sim,warp]'`) `--warp` compares `WarpSkin` with the skin instead, on the same touches.
"""

import argparse
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, root
from scipy.spatial import ConvexHull

from plantar.bench.tables import markdown_table
from plantar.errors import PlantarError
from plantar.mujoco import Skin

KINDS = mujoco.mjtGeom
BORDER = 1e-6  # of a cosine or a metre
DEPTH = 1e-4  # m: how deep a probe is pressed in
PROBES = ("sphere", "mesh", "slab", "height field")
ROOT = Path(__file__).resolve().parents[1]
PAGE = """# Patches of skin against an independent count

`python benchmarks/skin_touches.py` of the files of {count} public models; commit {commit}. Its `--help`
has what is pressed where and how it is counted. Forces are compared taxel by taxel, in shares of the touch's force:
1e-9 is asked for. *Touches* are contacts with a force; *silent* readings are those of a patch that none of the body's
contacts touches, and *phantom* the largest force on a taxel in those, in N. *Farthest lit cell*: distance of its middle
from the touch in cell widths (of one at a rim, in distances of the nearest cell). *Refused* are drawn patches where the
body has no surface or a strip.

"""
OUTPUT = Path(__file__).with_suffix(".md")
HEAD = (
    "patches", "taxels", "touches", "largest error of a taxel", "of the sum", "farthest lit cell", "silent",
    "phantom N", "on a border", "refused",
)  # fmt: skip
WARP_PAGE = """# Patches of skin in MuJoCo Warp

`python benchmarks/skin_touches.py --warp` of the files of {count} public models; commit {commit}. On the touches
of [its other page](skin_touches.md) `WarpSkin` reads the same contacts as the skin, as float32 numbers, on a CPU.
*Largest difference*: of a taxel's force or the wrench, in shares of the load; 1e-5 is asked for. *Other carried*:
readings in which it says otherwise whether the taxels carry the wrench.

"""
WARP_OUTPUT = Path(__file__).with_name("warp_patches.md")
WARP_HEAD = ("patches", "taxels", "touched", "silent", "largest difference", "other carried", "on a border")
PRISM = [[np.cos(a), np.sin(a), z] for z in (-1.0, 1.0) for a in np.arange(5) * 0.4 * np.pi]


@dataclass
class Count:
    """What was compared on one model."""

    name: str
    taxels: int = 0
    patches: int = 0
    touches: int = 0
    silent: int = 0
    border: int = 0
    refused: list[str] = field(default_factory=list)
    taxel_error: float = 0.0
    sum_error: float = 0.0
    phantom: float = 0.0
    farthest: float = 0.0
    warp_error: float = 0.0
    uncarried: int = 0

    def of_touches(self) -> list[str]:
        return [
            str(self.patches), str(self.taxels), str(self.touches), f"{self.taxel_error:.0e}", f"{self.sum_error:.0e}",
            f"{self.farthest:.2f}", str(self.silent), f"{self.phantom:g}", str(self.border), str(len(self.refused)),
        ]  # fmt: skip

    def of_warp(self) -> list[str]:
        return [
            str(self.patches), str(self.taxels), str(self.touches), str(self.silent), f"{self.warp_error:.0e}",
            str(self.uncarried), str(self.border),
        ]  # fmt: skip


def with_probes(spec: Any) -> Any:
    """The compiled model with the four probes, far away."""
    spec.add_mesh(name="probe_prism", uservert=(0.02 * np.array(PRISM)).ravel())
    hills = [0.5 + 0.5 * np.sin(2.0 * i) * np.cos(1.7 * j) for i in range(9) for j in range(9)]
    spec.add_hfield(name="probe_hills", nrow=9, ncol=9, size=[0.4, 0.4, 0.02, 0.05], userdata=hills)
    kinds = (KINDS.mjGEOM_SPHERE, KINDS.mjGEOM_MESH, KINDS.mjGEOM_BOX, KINDS.mjGEOM_HFIELD)
    for name, kind in zip(PROBES, kinds, strict=True):
        body = spec.worldbody.add_body(name=f"probe {name}", pos=[50.0, 0.0, 0.0])
        owner = spec.worldbody
        if kind != KINDS.mjGEOM_HFIELD:
            body.mocap = True
            owner = body
        geom = owner.add_geom(name=f"probe {name}", type=kind, contype=1, conaffinity=1, margin=0.0, gap=0.0)
        geom.contype = geom.conaffinity = 2**30 - 1
        geom.condim = 4
        geom.friction = [0.7, 0.01, 0.001]
        if kind == KINDS.mjGEOM_MESH:
            geom.meshname = "probe_prism"
        elif kind == KINDS.mjGEOM_HFIELD:
            geom.hfieldname = "probe_hills"
            geom.pos = [50.0, 50.0, 0.0]
        else:
            geom.size = [0.02, 0.02, 0.02] if kind == KINDS.mjGEOM_SPHERE else [0.3, 0.3, 0.02]
    return spec.compile()


class Hull:
    """Faces of one geom, found from its corners or sizes, in its frame."""

    def __init__(self, model: Any, geom: int) -> None:
        self.kind = int(model.geom_type[geom])
        self.size = model.geom_size[geom]
        self.planes = np.zeros((0, 4))
        if self.kind == KINDS.mjGEOM_BOX:
            self.planes = np.array([[*(s * np.eye(3)[j]), self.size[j]] for j in range(3) for s in (1.0, -1.0)])
        elif self.kind == KINDS.mjGEOM_MESH:
            mesh = int(model.geom_dataid[geom])
            first = int(model.mesh_vertadr[mesh])
            corners = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])].astype(float)
            start = int(model.mesh_graphadr[mesh])
            if start >= 0:  # corners of the hull that MuJoCo collides
                count = int(model.mesh_graph[start])
                corners = corners[model.mesh_graph[start + 2 + count : start + 2 + 2 * count]]
            equations = ConvexHull(corners).equations
            self.planes = np.column_stack([equations[:, :3], -equations[:, 3]])

    def faces(self, place: NDArray[np.float64], out: NDArray[np.float64], slack: float) -> list[NDArray[np.float64]]:
        """Normals of the face that turns least from a contact's normal, or of several that do so to a millionth."""
        if self.kind in (KINDS.mjGEOM_SPHERE, KINDS.mjGEOM_CAPSULE, KINDS.mjGEOM_ELLIPSOID):
            return [out]
        normals = self.planes[:, :3]
        away = self.planes[:, 3] - normals @ place
        if self.kind == KINDS.mjGEOM_CYLINDER:
            wide = float(np.hypot(place[0], place[1]))
            side = np.array([place[0], place[1], 0.0]) / max(wide, 1e-12)
            cap = np.array([0.0, 0.0, 1.0 if out[2] > 0.0 else -1.0])
            normals = np.array([side, cap])
            away = np.array([self.size[0] - wide, self.size[1] - cap[2] * place[2]])
        near = away <= slack + 1e-3 * self.size.sum()
        turned = np.where(near if (near & (normals @ out > 0.0)).any() else True, normals @ out, -2.0)
        return list(normals[turned >= turned.max() - BORDER])


def touches(skin: Skin, feel: Any, hulls: dict[int, Hull], data: Any, contact: Any) -> bool | None:
    """Whether a contact of the body is one of the patch; None on its border."""
    own = contact.geom2 if contact.geom2 in feel.geom_ids else contact.geom1
    sign = 1.0 if own == contact.geom2 else -1.0
    out = -sign * contact.frame[:3]
    place = contact.pos - 0.5 * contact.dist * out
    frame = data.geom_xmat[own].reshape(3, 3)
    local = frame.T @ (place - data.geom_xpos[own])
    body = data.xmat[feel.body].reshape(3, 3)
    at = body.T @ (place - data.xpos[feel.body])
    answers = set()
    for normal in hulls[own].faces(local, frame.T @ out, abs(0.5 * contact.dist)):
        facing = body.T @ frame @ normal
        margins = []
        if skin.outward is not None:
            way = np.array(skin.outward) / np.linalg.norm(skin.outward)
            margins.append(float(facing @ way) - np.cos(np.radians(skin.within)))
        if skin.around is not None:
            axis = np.array(skin.around) / np.linalg.norm(skin.around)
            margins.append(np.sqrt(0.5) - abs(float(facing @ axis)))
        if skin.region is not None:
            low, high = np.array(skin.region)
            margins += [float((at - low).min()), float((high - at).min())]
        answers |= {None} if abs(min(margins)) < BORDER else {min(margins) > 0.0}
    return answers.pop() if len(answers) == 1 else None


def shares(feel: Any, place: NDArray[np.float64], inward: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """Part (n,) of a touch that each cell has, by the definition; all in the patch's frame."""
    away = feel.layout.positions - place
    facing = feel.layout.rotations[:, :, 2] @ inward
    far = (away**2).sum(axis=1)
    weights = np.where((facing > 1e-9) & (far < radius**2), feel.layout.areas * facing * (1.0 - far / radius**2), 0.0)
    if not weights.any():
        return np.eye(len(feel))[int(np.argmin(far))]
    rows = np.column_stack([np.ones(len(away)), away @ np.linalg.svd(inward[None])[2][1:].T / radius])
    total = float(weights.sum())

    def missed(tilt: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray((weights * np.maximum(0.0, rows @ tilt)) @ rows / total - [1.0, 0.0, 0.0])

    def cost(tilt: NDArray[np.float64]) -> float:  # convex; its gradient is what is missed
        return float(0.5 * weights @ np.maximum(0.0, rows @ tilt) ** 2 / total - tilt[0])

    def curvature(tilt: NDArray[np.float64]) -> NDArray[np.float64]:
        loaded = rows[rows @ tilt > 0.0]
        return np.asarray((loaded.T * weights[rows @ tilt > 0.0]) @ loaded / total)

    found = root(missed, [1.0, 0.0, 0.0], jac=curvature, tol=1e-15)
    if np.abs(found.fun).max() > 1e-12:  # from where the convex cost is least
        start = minimize(cost, [1.0, 0.0, 0.0], jac=missed, hess=curvature, method="trust-exact", tol=1e-10).x
        found = root(missed, start, jac=curvature, tol=1e-15)
    if np.abs(found.fun).max() > 1e-12:  # beyond the outermost cells
        return np.asarray(weights / total)
    return np.asarray(weights * np.maximum(0.0, rows @ found.x) / total)


def is_clear(skin: Skin, feel: Any, hulls: dict[int, Hull], data: Any) -> bool:
    """Whether no contact of the body is on a patch's border."""
    own = feel.geom_ids
    seen = [c for c in data.contact if (c.geom[0] in own) != (c.geom[1] in own)]
    return all(touches(skin, feel, hulls, data, contact) is not None for contact in seen)


def compare(skin: Skin, feel: Any, hulls: dict[int, Hull], data: Any, count: Count) -> None:
    """Add one reading to a count."""
    turn = data.xmat[feel.body].reshape(3, 3) @ feel.rotation_to_body
    origin = data.xpos[feel.body] + data.xmat[feel.body].reshape(3, 3) @ feel.position_in_body
    width = np.sqrt(feel.layout.areas.mean() * 2.0 / np.sqrt(3.0))
    radius = feel.wraps[3]
    expected = np.zeros((len(feel), 3))
    places = []
    local = np.zeros(6)
    for i, contact in enumerate(data.contact):
        first, second = (g in feel.geom_ids for g in contact.geom)
        if first == second:
            continue
        touched = touches(skin, feel, hulls, data, contact)
        if touched is None:
            count.border += 1
            return
        if not touched or contact.efc_address < 0:
            continue
        frame = (1.0 if second else -1.0) * contact.frame.reshape(3, 3)
        mujoco.mj_contactForce(feel.model, data, i, local)
        if not local.any():
            continue
        place = turn.T @ (contact.pos + 0.5 * contact.dist * frame[0] - origin)
        expected += shares(feel, place, turn.T @ frame[0], radius)[:, None] * (turn.T @ frame.T @ local[:3])
        places.append(place)
    reading = feel(data)
    if not places:
        count.silent += 1
        count.phantom = max(count.phantom, float(np.abs(reading.vectors).max()))
        return
    load = max(float(np.linalg.norm(expected.sum(axis=0))), 1.0)
    count.touches += len(places)
    count.taxel_error = max(count.taxel_error, float(np.abs(reading.vectors - expected).max()) / load)
    total = reading.vectors.sum(axis=0) - expected.sum(axis=0)
    count.sum_error = max(count.sum_error, float(np.abs(total).max()) / load)
    lit = feel.layout.positions[np.abs(reading.vectors).max(axis=1) > 0.0]
    away = np.linalg.norm(lit[:, None] - np.array(places)[None], axis=2).min(axis=1)
    alone = np.linalg.norm(feel.layout.positions[:, None] - np.array(places)[None], axis=2).min(axis=0)
    # A touch at a rim lights the nearest cell, however near that is.
    count.farthest = max(count.farthest, float(away.max() / max(width, alone.max())))


def press(model: Any, data: Any, body: int, own: list[int], name: str, rng: np.random.Generator) -> bool:
    """Press a probe on a body from a drawn direction, sliding; False if nothing touches."""
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    probe = model.geom(f"probe {name}").id
    middle = data.geom_xpos[own[rng.integers(len(own))]].copy()
    if name == "height field":
        way = np.array([0.0, 0.0, -1.0])
    carrier = int(model.geom_bodyid[probe])
    mocap = int(model.body_mocapid[carrier]) if carrier else -1
    if name in ("mesh", "slab"):
        quat = rng.normal(size=4) if name == "mesh" else np.empty(4)
        if name == "slab":
            mujoco.mju_quatZ2Vec(quat, way)
        data.mocap_quat[mocap] = quat / np.linalg.norm(quat)
    reach = 1.5
    near = 0.0
    for _ in range(45):
        place = middle + 0.5 * (near + reach) * way
        if mocap >= 0:
            data.mocap_pos[mocap] = place
        else:
            model.geom_pos[probe] = place
            model.geom_sameframe[probe] = 0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        gap = min(_gap(model, data, g, probe) for g in own)
        near, reach = (near, 0.5 * (near + reach)) if gap > -DEPTH else (0.5 * (near + reach), reach)
    data.qvel[:] = 0.05 * rng.normal(size=model.nv)
    mujoco.mj_forward(model, data)
    return any((c.geom1 in own) != (c.geom2 in own) for c in data.contact)


def _gap(model: Any, data: Any, geom: int, probe: int) -> float:
    if model.geom_type[probe] != KINDS.mjGEOM_HFIELD:
        return float(mujoco.mj_geomDistance(model, data, geom, probe, 3.0, None))
    # No distance to a height field: from where its contacts begin.
    mujoco.mj_collision(model, data)
    depths = [c.dist for c in data.contact if {c.geom1, c.geom2} == {geom, probe}]
    return min(depths, default=1.0)


def away(model: Any, data: Any) -> None:
    """Put all probes where they touch nothing."""
    data.mocap_pos[:] = [50.0, 0.0, 0.0]
    model.geom_pos[model.geom("probe height field").id] = [50.0, 50.0, 0.0]


def bodies_of(model: Any, most: int) -> list[int]:
    """Some bodies that move and have shapes that collide, evenly among all."""
    shapes = np.flatnonzero((model.geom_contype | model.geom_conaffinity) != 0)
    kinds = (KINDS.mjGEOM_PLANE, KINDS.mjGEOM_HFIELD)
    able = sorted({int(model.geom_bodyid[g]) for g in shapes if model.geom_type[g] not in kinds})
    able = [
        b for b in able if model.body_weldid[b] and not model.body(b).name.startswith("probe") and model.body(b).name
    ]
    return [able[i] for i in np.unique(np.linspace(0, len(able) - 1, min(most, len(able))).astype(int))] if able else []


def compare_warp(bound: list[tuple[Any, Any]], model: Any, data: Any, count: Count) -> None:
    """Add the differences of MuJoCo Warp's form to a count; `bound`: skins, each with its `WarpSkin`."""
    import mujoco_warp

    worlds = mujoco_warp.put_data(model, data, nworld=1)
    for feel, many in bound:
        many.read(worlds)
        vectors, wrench, carried = many.numpy()
        reading = feel(data)
        load = max(float(np.linalg.norm(reading.wrench[:3])), 1.0)
        off = max(float(np.abs(vectors[0] - reading.vectors).max()), float(np.abs(wrench[0] - reading.wrench).max()))
        count.warp_error = max(count.warp_error, off / load)
        count.uncarried += bool(carried[0]) != reading.carried
        count.touches += bool(reading.vectors.any())
        count.silent += not reading.vectors.any()


def counted(name: str, spec: Any, most: int = 3, seed: int = 0, warp: bool = False) -> Count | None:
    """Compare on one model; None for one without a body that can wear a skin."""
    model = with_probes(spec)
    count = Count(name)
    rng = np.random.default_rng(seed)
    for body in bodies_of(model, most):
        data = mujoco.MjData(model)
        if model.nkey:
            mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_forward(model, data)
        _at_body(model, data, body, count, rng, warp)
    return count if count.patches else None


def _at_body(model: Any, data: Any, body: int, count: Count, rng: np.random.Generator, warp: bool) -> None:
    name = model.body(body).name
    whole = np.array([[-9.0] * 3, [9.0] * 3])
    axis = np.eye(3)[rng.integers(3)]
    cut = whole.copy()
    cut[rng.integers(2), rng.integers(3)] = 0.0
    wanted: list[dict[str, Any]] = [
        {"outward": tuple(rng.normal(size=3))},
        {"around": tuple(axis)},
        {"outward": tuple(rng.normal(size=3)), "within": 110.0, "region": cut},
    ]
    bound = []
    for options in wanted:
        skin = Skin(body=name, **options)
        try:
            bound.append((skin, skin.bind(model)))
        except PlantarError as problem:
            count.refused.append(str(problem))
    if not bound:
        return
    many = []
    if warp:
        from plantar.mujoco.warp_skin import WarpSkin

        many = [(feel, WarpSkin(feel, 1)) for _, feel in bound]
    own = list(bound[0][1].geom_ids)
    hulls = {g: Hull(model, g) for g in own}
    count.patches += len(bound)
    count.taxels += sum(len(feel) for _, feel in bound)
    for probe in PROBES:
        for _ in range(3 if probe != "height field" else 1):
            away(model, data)
            mujoco.mj_forward(model, data)
            if press(model, data, body, own, probe, rng):
                if many:
                    clear = [is_clear(skin, feel, hulls, data) for skin, feel in bound]
                    count.border += clear.count(False)
                    compare_warp([pair for pair, one in zip(many, clear, strict=True) if one], model, data, count)
                    continue
                for skin, feel in bound:
                    compare(skin, feel, hulls, data, count)
    away(model, data)


def models_below(folder: Path) -> Iterator[tuple[str, Any]]:
    """Name and spec of each robot model of a file, or below a folder, that MuJoCo can compile."""
    for path in [folder] if folder.is_file() else sorted([*folder.rglob("*.xml"), *folder.rglob("*.urdf")]):
        try:
            spec = mujoco.MjSpec.from_file(str(path))
            model = spec.copy().compile()
        except (ValueError, mujoco.FatalError):
            continue
        if model.njnt >= 2 and bodies_of(model, 1):
            yield f"{path.parent.name}/{path.stem}", spec


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", type=Path, help="model files, or folders with some")
    parser.add_argument("--bodies", type=int, default=3, help="most bodies a model (3)")
    parser.add_argument("--warp", action="store_true", help="compare MuJoCo Warp's form too")
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    rows = []
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=ROOT).stdout
    page, head, output = (WARP_PAGE, WARP_HEAD, WARP_OUTPUT) if options.warp else (PAGE, HEAD, OUTPUT)
    for path in options.paths:
        for name, spec in models_below(path):
            try:
                count = counted(name, spec, options.bodies, warp=options.warp)
            except (ValueError, mujoco.FatalError) as problem:  # a model that takes no probes
                print(f"{name} is left out: {str(problem).splitlines()[0]}", flush=True)
                continue
            if count is None:
                continue
            print(count, flush=True)
            rows.append([name, *(count.of_warp() if options.warp else count.of_touches())])
            text = page.format(count=len(rows), commit=commit.strip()) + markdown_table(["model", *head], rows)
            (options.output or output).write_text(text)


if __name__ == "__main__":
    main()
