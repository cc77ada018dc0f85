"""The legs of a model, found without names: two alike chains of hinges."""

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.errors import RobotError
from plantar.robots.survey.body_surface import geom_triangles, resting_plane, shapes_of
from plantar.robots.survey.wishes import found

LEAST_JOINTS = 4
"""Hinges that a leg has at least: roll and pitch of the hip, knee and pitch of the ankle."""

_NEAR_FLOOR = 0.15  # of the height of its joint: how far a part of the foot may be above the sole
_FLAT = 0.25  # share of its silhouette that the plane has that a foot rests on
_AS_LOW = 0.1  # of the robot's height: how far two feet of a pair may differ
_STANDS = 0.45  # of a limb's farthest reach: a model that is lower than twice that lies, or has another axis up
_AXES_APART = math.cos(math.radians(20.0))  # how far the line between the feet may be off an axis
# it may be so far, and off the hips' line
_ON_AXIS = math.cos(math.radians(2.0))
_ALONG = math.cos(math.radians(0.5))
_AHEAD = 0.03  # of the foot's length: what shows toes from heel

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Leg:
    """One leg.

    `joints`: ids of its hinges from hip to ankle; `foot`: id of body that the last one moves; `parts`: ids of all
    bodies that move with foot; `toes`: names of held hinges below foot; `ankle`: point (3,) in m that the foot turns
    about, model's world.
    """

    joints: tuple[int, ...]
    foot: int
    parts: frozenset[int]
    toes: tuple[str, ...]
    ankle: Array


@dataclass(frozen=True)
class Legs:
    """Both legs, and the model's rotation to stand upright along x.

    `rotation`: rotation (3, 3) from the model's world to x forward, y left, z up; `notes`: how that was found.
    """

    by_side: dict[Side, Leg]
    pelvis: int
    rotation: Array
    notes: tuple[str, ...]


def find_legs(model: Any, data: Any, where: str, feet: tuple[str, str] | None = None) -> Legs:
    """Returns the legs of a `model` in state `data`; errors name the file `where`.

    `feet`: names of the bodies that legs end in; None: those that stand lowest.
    """
    tree = _Tree(model, data)
    up, how = _upwards(tree, where)
    if feet is None:
        pair = _pair(tree, up, where)
        ends = _feet_of(tree, up, pair)
    else:
        pair = _named_pair(tree, feet, where)
        ends = [len(chain) for chain in pair]
    lower = [_leg(tree, chain[:end], where) for chain, end in zip(pair, ends, strict=True)]
    rotation, notes = _facing(tree, up, lower, where)
    across = [float((rotation @ leg.ankle)[1]) for leg in lower]
    left, right = lower if across[0] > across[1] else lower[::-1]
    return Legs({"left": left, "right": right}, tree.pelvis(pair), rotation, (*how, *notes))


class _Tree:
    def __init__(self, model: Any, data: Any) -> None:
        self.model = model
        self.data = data
        self.links = sorted({int(i) for i in model.body_weldid})
        self.bodies = {i: frozenset(np.flatnonzero(model.body_weldid == i).tolist()) for i in self.links}
        self.above = {i: int(model.body_weldid[model.body_parentid[i]]) for i in self.links if i > 0}
        self.points: dict[int, Array] = {}
        for i in self.links:
            shapes = [g for group in shapes_of(model, self.bodies[i]) for g in group]
            if i > 0 and shapes:
                self.points[i] = np.concatenate([geom_triangles(model, data, g).reshape(-1, 3) for g in shapes])

    def chain(self, link: int) -> list[int]:
        found = []
        while link > 0:
            found.append(link)
            link = self.above[link]
        return found

    def joints(self, link: int) -> list[int]:
        first = int(self.model.body_jntadr[link])
        count = int(self.model.body_jntnum[link])
        return [j for j in range(first, first + count) if self.model.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE]

    def hinges(self, links: list[int]) -> list[int]:
        return [j for i in links for j in self.joints(i) if self.model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]

    def below(self, link: int) -> list[int]:
        return [i for i in self.links if link in self.chain(i)]

    def pelvis(self, pair: tuple[list[int], list[int]]) -> int:
        above = [self.above[pair[0][0]], *(int(self.model.body_parentid[chain[0]]) for chain in pair)]
        return next((b for b in above if b > 0), pair[0][0])


def _upwards(tree: _Tree, where: str) -> tuple[Array, tuple[str, ...]]:
    """Up (3,) in the model's world: away from the farthest hanging part."""
    model = tree.model
    com = tree.data.subtree_com[0]
    ends = [i for i in tree.points if len(tree.hinges(tree.chain(i))) >= LEAST_JOINTS]
    if not ends:
        longest = max(tree.points, key=lambda i: len(tree.hinges(tree.chain(i))), default=0)
        there = (
            f"the longest, to '{model.body(longest).name}', has {len(tree.hinges(tree.chain(longest)))}"
            if longest
            else f"its {model.ngeom} shapes are all on bodies that no joint moves, so that it has no feet"
        )
        raise RobotError(
            f"{where}: no chain of {LEAST_JOINTS} hinges or more ends in a body with a shape; {there}; a leg that "
            "walks has roll and pitch in its hip, a knee, and pitch in its ankle"
        )
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    below = {i: ((com - p) @ axes.T).max(axis=0) for i, p in tree.points.items()}  # the CoM, seen along each axis
    soles = [max(ends, key=lambda i: float(below[i][k])) for k in range(6)]
    reach = np.array([below[sole][k] for k, sole in enumerate(soles)])
    up = int((reach * [1.2 if len(tree.hinges(tree.chain(sole))) <= 8 else 1.0 for sole in soles]).argmax())
    rest = max((float(b[2]) for i, b in below.items() if i not in ends), default=-math.inf)
    half = 0.5 * float(max(b[2] for b in below.values()) + max(b[5] for b in below.values()))
    if up == 2 or (reach[2] > max(0.0, rest - 1e-6) and max(reach[2], half) > _STANDS * reach.max()):
        return axes[2], ()
    return axes[up], (f"the model lies: its {_axis_name(axes[up])} axis points up",)


def _axis_name(axis: Array) -> str:
    i = int(np.abs(axis).argmax())
    return f"{'-' if axis[i] < 0.0 else ''}{'xyz'[i]}"


def _pair(tree: _Tree, up: Array, where: str) -> tuple[list[int], list[int]]:
    height = {i: float((p @ up).min()) for i, p in tree.points.items()}
    top = max(float((p @ up).max()) for p in tree.points.values())
    ends = sorted((i for i in height if len(tree.hinges(tree.chain(i))) >= LEAST_JOINTS), key=height.__getitem__)
    first = ends[0]
    limbs: list[tuple[list[int], int, list[int]]] = []  # the lowest end of each limb that reaches as low
    for other in ends[1:]:
        one, two = _apart(tree, first, other)
        counts = [len(tree.hinges(chain)) for chain in (one, two)]
        if min(counts) < LEAST_JOINTS:
            continue
        if height[other] - height[first] > _AS_LOW * (top - height[first]):
            break
        if all(min(len(tree.hinges(c)) for c in _apart(tree, other, k[1])) >= LEAST_JOINTS for k in limbs):
            limbs.append((one, other, two))
    if len(limbs) != 1:
        names = ", ".join(tree.model.body(i).name for i in (first, *(k[1] for k in limbs)))
        what = "only one limb" if not limbs else f"{len(limbs) + 1} limbs"
        raise RobotError(
            f"{where}: {what} of {LEAST_JOINTS} hinges or more that share no joint reach the ground ({names}); "
            "allowed: two legs; name their feet: --foot left,right"
        )
    limb = limbs[0][0], limbs[0][2]
    legs = {j for chain in limb for i in chain for j in tree.below(i)}
    lower = [i for i in height if i not in legs and height[i] < height[first] - _AS_LOW * (top - height[first])]
    if lower:
        raise RobotError(
            f"{where}: what stands on the ground is no leg: '{tree.model.body(lower[0]).name}' reaches lower than "
            f"'{tree.model.body(first).name}'; allowed: a robot on two legs of {LEAST_JOINTS} hinges or more"
        )
    return limb


def _apart(tree: _Tree, a: int, b: int) -> tuple[list[int], list[int]]:
    one = tree.chain(a)[::-1]
    two = tree.chain(b)[::-1]
    shared = 0
    while shared < min(len(one), len(two)) and one[shared] == two[shared]:
        shared += 1
    return one[shared:], two[shared:]


def _feet_of(tree: _Tree, up: Array, pair: tuple[list[int], list[int]]) -> list[int]:
    """Links of each leg's chain as far as its foot: of legs of as many hinges, both end at the lower one's.

    What is below a foot that is drawn too low, as an ankle of GR3's right leg is, is no toe of it then.
    """
    ends = [_foot_of(tree, up, chain) for chain in pair]
    one, two = pair
    alike = [len(tree.hinges([i])) for i in one] == [len(tree.hinges([i])) for i in two]
    return [max(ends)] * 2 if alike else ends


def _foot_of(tree: _Tree, up: Array, chain: list[int]) -> int:
    """Links of a chain as far as its foot, the highest one on the floor."""
    up = _above_sole(tree.points[chain[-1]], up)
    floor = float((tree.points[chain[-1]] @ up).min())
    last = len(chain) - 1
    # Of a leg of five hinges the last one is its ankle, and a shank that reaches far down is no foot.
    while last > 0 and len(tree.hinges(chain[:last])) > LEAST_JOINTS and chain[last - 1] in tree.points:
        anchor = float(tree.data.xanchor[tree.joints(chain[last - 1])[-1]] @ up)
        if float((tree.points[chain[last - 1]] @ up).min()) - floor > _NEAR_FLOOR * (anchor - floor):
            break
        last -= 1
    return last + 1


def _named_pair(tree: _Tree, feet: tuple[str, str], where: str) -> tuple[list[int], list[int]]:
    names = [tree.model.body(i).name for i in range(1, tree.model.nbody)]
    for name in feet:
        found(names, name, "--foot", where)
    left, right = (int(tree.model.body_weldid[tree.model.body(name).id]) for name in feet)
    pair = _apart(tree, left, right)
    for name, chain in zip(feet, pair, strict=True):
        if len(tree.hinges(chain)) < LEAST_JOINTS:
            raise RobotError(
                f"{where}: --foot names '{name}', which {len(tree.hinges(chain))} hinges move apart from the other "
                f"foot; allowed: {LEAST_JOINTS} or more"
            )
    return pair


def _leg(tree: _Tree, links: list[int], where: str) -> Leg:
    """The leg whose last link is its foot."""
    model = tree.model
    data = tree.data
    foot = links[-1]
    hinges = tree.hinges(links)
    other = next((j for i in links for j in tree.joints(i) if j not in hinges), None)
    if other is not None:
        raise RobotError(f"{where}: joint '{model.joint(other).name}' of a leg is no hinge; allowed: hinges")
    bare = [i for i in tree.below(foot) if tree.joints(i) and not any(b in tree.points for b in tree.below(i))]
    if bare:
        raise RobotError(
            f"{where}: '{model.body(bare[-1]).name}', which moves below '{model.body(foot).name}', has no shape; "
            "allowed: feet of a mesh, box or sphere, and fixed joints of what has no shape below a foot"
        )
    points = [tree.points[i] for i in tree.below(foot) if i in tree.points]
    if not points:
        raise RobotError(f"{where}: '{model.body(foot).name}' has no shape; allowed: feet of a mesh, box or sphere")
    parts = frozenset(b for i in tree.below(foot) for b in tree.bodies[i])
    toes = tuple(model.joint(j).name for i in tree.below(foot) if i != foot for j in tree.joints(i))
    return Leg(tuple(hinges), foot, parts, toes, _ankle(data, hinges, tree.points.get(foot, points[0])))


def _above_sole(points: Array, up: Array) -> Array:
    """Direction (3,) up from the plane that a foot rests on."""
    side = np.eye(3)[int(np.abs(up).argmin())]
    level = np.stack([np.cross(side, up), np.cross(up, np.cross(side, up)), up])
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    normal, share = resting_plane(points @ level.T)
    return np.asarray(-normal @ level) if share > _FLAT else up


def _ankle(data: Any, hinges: list[int], foot: Array) -> Array:
    """Where a leg's last axes meet, or the last's middle if parallel."""
    a = hinges[-1]
    b = hinges[-2]
    p = data.xanchor[a]
    u = data.xaxis[a]
    q = data.xanchor[b]
    v = data.xaxis[b]
    parallel = float(u @ v)
    if abs(parallel) > 0.9:
        middle = 0.5 * (foot.min(axis=0) + foot.max(axis=0))
        return np.asarray(p + ((middle - p) @ u) * u)
    across = q - p
    return np.asarray(p + (across @ u - (across @ v) * parallel) / (1.0 - parallel**2) * u)


def _facing(tree: _Tree, up: Array, legs: list[Leg], where: str) -> tuple[Array, tuple[str, ...]]:
    data = tree.data
    hips = [data.xanchor[leg.joints[0]] for leg in legs]
    lines = [d - (d @ up) * up for d in (legs[0].ankle - legs[1].ankle, hips[0] - hips[1])]
    apart = max(lines, key=lambda d: float(np.linalg.norm(d)))
    size = float(np.linalg.norm(apart))
    best = int(np.abs(apart).argmax())
    across = np.eye(3)[best]
    if abs(apart[best]) < _ON_AXIS * size and all(abs(d @ apart) > _ALONG * size * np.linalg.norm(d) for d in lines):
        across = apart / size  # hips and feet are on one line: the whole model is turned
    elif size < 1e-6 or abs(apart[best]) < _AXES_APART * size:
        raise RobotError(f"{where}: the feet stand neither along x nor along y next to each other; turn the model")
    forward = np.cross(across, up)
    votes, reason = _forward_votes(tree, legs, forward, up)
    forward = forward if (votes or float(forward[0]) * (abs(forward[0]) > 0.5)) >= 0.0 else -forward
    rotation = np.stack([forward, np.cross(up, forward), up])
    if np.allclose(rotation, np.eye(3)):
        return np.eye(3), ()
    off = math.degrees(math.acos(min(1.0, float(np.abs(forward).max()))))
    turned = f", turned by {off:.0f} degrees," if off > 1.0 else ""
    return rotation, (f"the robot looks along the model's {_axis_name(forward)} axis{turned} ({reason})",)


def _forward_votes(tree: _Tree, legs: list[Leg], forward: Array, up: Array) -> tuple[float, str]:
    """Positive where toes and knees indicate forward, negative for backward."""
    toes = 0.0
    knees = 0.0
    for leg in legs:
        foot = np.concatenate([tree.points[i] for i in tree.below(leg.foot) if i in tree.points]) @ forward
        ahead = 0.5 * float(foot.min() + foot.max()) - float(leg.ankle @ forward)
        toes += 0.0 if abs(ahead) < _AHEAD * float(np.ptp(foot)) else math.copysign(1.0, ahead)
        knees += _knee_vote(tree, leg, np.cross(up, forward))
    return 2.0 * toes + knees, "the toes are farther from the ankle than the heel" if toes else "the knees bend so"


def _knee_vote(tree: _Tree, leg: Leg, left: Array) -> float:
    """1 where the knee's range bends it forward, -1 for backward, else 0."""
    model = tree.model
    data = tree.data
    pitch = [j for j in leg.joints if abs(float(data.xaxis[j] @ left)) > 0.7]
    if len(pitch) < 3:
        return 0.0
    low, high = (model.jnt_range[pitch[-2]] - model.qpos0[model.jnt_qposadr[pitch[-2]]]).tolist()
    one_sided = high + low
    if not model.jnt_limited[pitch[-2]] or abs(one_sided) < 0.5 * (high - low):
        return 0.0
    return math.copysign(1.0, one_sided * float(data.xaxis[pitch[-2]] @ left))
