# mypy: ignore-errors
"""The contacts of a sole in many worlds of NVIDIA Warp, a thread a contact.

Numbers are float64, from MuJoCo Warp's float32 contacts.
"""

from __future__ import annotations

from typing import Any

try:
    import warp as wp
except ImportError:  # then the functions are not called
    wp = None

__all__ = ["Contacts", "Sole", "Work", "func", "gather", "kernel"]


def _as_it_is(function: Any) -> Any:
    return function


func: Any = _as_it_is if wp is None else wp.func
"""Warp's decorator of a function."""
kernel: Any = _as_it_is if wp is None else wp.kernel
"""Warp's decorator of a kernel."""
_struct: Any = _as_it_is if wp is None else wp.struct
if wp is not None:
    wp.set_module_options({"enable_backward": False})  # half of the time to compile


@_struct
class Sole:
    """A sole of n taxels and its frame in a body."""

    positions: wp.array(dtype=wp.vec3d)
    normals: wp.array(dtype=wp.vec3d)
    areas: wp.array(dtype=wp.float64)
    widths: wp.array(dtype=wp.float64)
    hull: wp.array(dtype=wp.vec2d)
    own: wp.array(dtype=wp.int32)
    body: wp.int32
    place: wp.vec3d
    turn: wp.mat33d
    reach: wp.float64
    level: wp.bool


@_struct
class Contacts:
    """All worlds' contacts, as MuJoCo Warp lists them."""

    count: wp.array(dtype=wp.int32)
    world: wp.array(dtype=wp.int32)
    dist: wp.array(dtype=wp.float32)
    pos: wp.array(dtype=wp.vec3f)
    frame: wp.array(dtype=wp.mat33f)
    geom: wp.array(dtype=wp.vec2i)
    dim: wp.array(dtype=wp.int32)
    friction: wp.array2d(dtype=wp.float32)
    address: wp.array2d(dtype=wp.int32)
    force: wp.array2d(dtype=wp.float32)
    xpos: wp.array2d(dtype=wp.vec3f)
    xmat: wp.array2d(dtype=wp.mat33f)
    elliptic: wp.bool


@_struct
class Work:
    """Each world's contacts in the sole frame (k, world), and work arrays (i, slot).

    A GPU has a slot a world, next to each other in memory; a CPU one, which its caches hold.
    """

    size: wp.array(dtype=wp.int32)
    pair: wp.array2d(dtype=wp.vec2i)
    gap: wp.array2d(dtype=wp.float64)
    at: wp.array2d(dtype=wp.vec3d)
    force: wp.array2d(dtype=wp.vec3d)
    torque: wp.array2d(dtype=wp.vec3d)
    points: wp.array2d(dtype=wp.vec3d)
    ring: wp.array2d(dtype=wp.vec2d)
    edges: wp.array2d(dtype=wp.vec3d)
    weights: wp.array2d(dtype=wp.float64)
    prior: wp.array2d(dtype=wp.float64)
    normal: wp.array2d(dtype=wp.float64)
    gaps: wp.array2d(dtype=wp.float64)
    rows: wp.array2d(dtype=wp.vec3d)
    vectors: wp.array2d(dtype=wp.vec3d)
    wrench: wp.array2d(dtype=wp.float64)
    carried: wp.array(dtype=wp.int32)


@kernel
def gather(sole: Sole, contacts: Contacts, work: Work):
    """Add each of the `contacts` to the lists of the `sole` in `work`, in its frame; a thread a contact."""
    i = wp.tid()
    if i >= contacts.count[0]:
        return
    geoms = contacts.geom[i]
    first, second = geoms[0], geoms[1]
    if first < 0 or second < 0 or (sole.own[first] != 0) == (sole.own[second] != 0):
        return
    world = contacts.world[i]
    k = wp.atomic_add(work.size, world, 1)
    if k >= work.gap.shape[0]:
        return
    local = wp.vec3d()
    twist = wp.vec3d()
    if contacts.address[i, 0] >= 0:
        dim = contacts.dim[i]
        if contacts.elliptic or dim == 1:
            for j in range(dim):
                value = wp.float64(contacts.force[world, contacts.address[i, j]])
                if j < 3:
                    local[j] = value
                else:
                    twist[j - 3] = value
        else:
            for j in range(1, dim):
                plus = wp.float64(contacts.force[world, contacts.address[i, 2 * j - 2]])
                minus = wp.float64(contacts.force[world, contacts.address[i, 2 * j - 1]])
                local[0] += plus + minus
                side = (plus - minus) * wp.float64(contacts.friction[i, j - 1])
                if j < 3:
                    local[j] = side
                else:
                    twist[j - 3] = side
    sign = wp.float64(1.0)
    if sole.own[first] != 0:
        sign = wp.float64(-1.0)
    turn = wp.mat33d(contacts.xmat[world, sole.body])
    to_sole = wp.transpose(turn @ sole.turn)
    origin = wp.vec3d(contacts.xpos[world, sole.body]) + turn @ sole.place
    axes = wp.transpose(wp.mat33d(contacts.frame[i])) * sign
    work.pair[k, world] = geoms
    work.gap[k, world] = wp.float64(contacts.dist[i])
    work.at[k, world] = to_sole @ (wp.vec3d(contacts.pos[i]) - origin)
    work.force[k, world] = to_sole @ (axes @ local)
    work.torque[k, world] = to_sole @ (axes @ twist)
