# mypy: ignore-errors
"""`plantar.kernels.contacts.patch_load` for many worlds by NVIDIA Warp, a thread a contact.

Numbers are float64, from MuJoCo Warp's float32 contacts; `wp.int32(0)` declares a variable that a loop changes.
"""

from __future__ import annotations

from plantar.mujoco.warp_kernels import Contacts, contact_load, func, kernel, side_of, struct, wp

if wp is not None:
    _CYLINDER = wp.constant(wp.int32(5))  # of mjtGeom
    _BOX = wp.constant(wp.int32(6))
    # Rounding of float32, where a place is on the border of a region or a cell faces a normal not at all.
    _LEVEL = wp.constant(wp.float64(1e-6))
    wp.set_module_options({"enable_backward": False})


@struct
class Patch:
    """A patch of n taxels in its frame, the surface that it lies on, and its frame in a body: see `PatchLoad`."""

    positions: wp.array(dtype=wp.vec3d)
    normals: wp.array(dtype=wp.vec3d)
    areas: wp.array(dtype=wp.float64)
    radius: wp.float64
    own: wp.array(dtype=wp.int32)
    geoms: wp.array(dtype=wp.int32)
    kinds: wp.array(dtype=wp.int32)
    places: wp.array(dtype=wp.vec3d)
    turns: wp.array(dtype=wp.mat33d)
    sizes: wp.array(dtype=wp.vec3d)
    starts: wp.array(dtype=wp.int32)
    planes: wp.array(dtype=wp.vec4d)
    way: wp.vec3d
    way_least: wp.float64
    axis: wp.vec3d
    axis_most: wp.float64
    low: wp.vec3d
    high: wp.vec3d
    polygon: wp.array(dtype=wp.vec2d)
    body: wp.int32
    place: wp.vec3d
    turn: wp.mat33d
    reach: wp.float64


@struct
class PatchWork:
    """Cells about a contact (k, slot), and what worlds' patches carry.

    A GPU has a slot a contact, next to each other in memory; a CPU one, which its caches hold.
    """

    rows: wp.array2d(dtype=wp.vec3d)
    cells: wp.array2d(dtype=wp.int32)
    load: wp.array(dtype=wp.float64)
    extent: wp.array(dtype=wp.float64)
    vectors: wp.array2d(dtype=wp.vec3d)
    wrench: wp.array2d(dtype=wp.float64)
    carried: wp.array(dtype=wp.int32)


@func
def _face(patch: Patch, row: wp.int32, place: wp.vec3d, out: wp.vec3d, slack: wp.float64):
    kind = patch.kinds[row]
    if kind < _CYLINDER:  # round: the contact's own normal
        return out
    turn = patch.turns[row]
    size = patch.sizes[row]
    at = wp.transpose(turn) @ (place - patch.places[row])
    way = wp.transpose(turn) @ out
    best = wp.float64(-2.0)
    found = wp.vec3d()
    zero = wp.float64(0.0)
    for attempt in range(2):  # then any face, if none is near
        far = slack + wp.float64(1e-3) * (size[0] + size[1] + size[2])
        if attempt == 1:
            far = wp.float64(1e300)
        if best <= zero:
            if kind == _BOX:
                for j in range(3):
                    sign = wp.where(way[j] > zero, wp.float64(1.0), wp.float64(-1.0))
                    if size[j] - sign * at[j] <= far and wp.abs(way[j]) > best + _LEVEL:
                        best = wp.abs(way[j])
                        found = wp.vec3d()
                        found[j] = sign
            elif kind == _CYLINDER:
                wide = wp.sqrt(at[0] * at[0] + at[1] * at[1])
                if size[0] - wide <= far and wide > zero:
                    best = (way[0] * at[0] + way[1] * at[1]) / wide
                    found = wp.vec3d(at[0] / wide, at[1] / wide, zero)
                sign = wp.where(way[2] > zero, wp.float64(1.0), wp.float64(-1.0))
                if size[1] - sign * at[2] <= far and wp.abs(way[2]) > best + _LEVEL:
                    best = wp.abs(way[2])
                    found = wp.vec3d(zero, zero, sign)
            else:
                for p in range(patch.starts[row], patch.starts[row + 1]):
                    plane = patch.planes[p]
                    normal = wp.vec3d(plane[0], plane[1], plane[2])
                    along = wp.dot(normal, way)
                    if along > best + _LEVEL and plane[3] - wp.dot(normal, at) <= far:
                        best = along
                        found = normal
    if best > zero:
        return turn @ found
    return out


@func
def _has(patch: Patch, at: wp.vec3d, face: wp.vec3d) -> wp.bool:
    if wp.dot(patch.way, face) < patch.way_least - _LEVEL:
        return False
    if wp.abs(wp.dot(patch.axis, face)) > patch.axis_most + _LEVEL:
        return False
    in_box = patch.turn @ at
    for j in range(3):
        if in_box[j] < patch.low[j] - _LEVEL or in_box[j] > patch.high[j] + _LEVEL:
            return False
    count = patch.polygon.shape[0]
    if count == 0:
        return True
    inside = wp.int32(0)
    for i in range(count):
        a = patch.polygon[i]
        b = patch.polygon[(i + count - 1) % count]
        if (a[1] > at[1]) != (b[1] > at[1]) and at[0] < (b[0] - a[0]) * (at[1] - a[1]) / (b[1] - a[1]) + a[0]:
            inside = 1 - inside
    return inside == 1


@func
def _gather(patch: Patch, work: PatchWork, s: wp.int32, place: wp.vec3d, out: wp.vec3d) -> wp.int32:
    across = wp.vec3d(wp.float64(0.0), out[2], -out[1])
    if wp.abs(out[0]) >= wp.float64(0.6):
        across = wp.vec3d(-out[2], wp.float64(0.0), out[0])
    across = wp.normalize(across)
    other = wp.cross(out, across)
    square = patch.radius * patch.radius
    count = wp.int32(0)
    for i in range(patch.areas.shape[0]):
        off = patch.positions[i] - place
        away = wp.dot(off, off)
        facing = -wp.dot(patch.normals[i], out)
        if away < square and facing > _LEVEL and count < work.cells.shape[0]:
            weight = patch.areas[i] * facing * (wp.float64(1.0) - away / square)
            work.rows[count, s] = wp.vec3d(weight, wp.dot(across, off), wp.dot(other, off))
            work.cells[count, s] = i
            count += 1
    return count


@func
def _nearest(patch: Patch, place: wp.vec3d) -> wp.int32:
    nearest = wp.int32(0)
    least = wp.float64(1e300)
    for i in range(patch.areas.shape[0]):
        off = patch.positions[i] - place
        away = wp.dot(off, off)
        if away < least:
            least = away
            nearest = i
    return nearest


@func
def _surrounded(work: PatchWork, s: wp.int32, count: wp.int32, at: wp.vec2d) -> wp.bool:
    small = wp.float64(1e-9)
    for i in range(count):
        p = wp.vec2d(work.rows[i, s][1], work.rows[i, s][2]) - at
        if wp.dot(p, p) < wp.float64(1e-18):
            return True
        left = wp.int32(0)
        right = wp.int32(0)
        for j in range(count):
            q = wp.vec2d(work.rows[j, s][1], work.rows[j, s][2]) - at
            turned = p[0] * q[1] - p[1] * q[0]
            if turned > small:
                left = 1
            if turned < -small:
                right = 1
            if wp.abs(turned) <= small and wp.dot(p, q) < wp.float64(0.0):
                left = 1
                right = 1
        if left * right == 0:
            return False
    return count > 0


@func
def _tilted(work: PatchWork, s: wp.int32, count: wp.int32, load: wp.vec3d):
    zero = wp.float64(0.0)
    field = wp.vec3d(wp.float64(1.0), zero, zero)
    step = wp.vec3d()
    slope = wp.float64(0.0)
    value = wp.float64(0.0)
    rate = wp.float64(1.0)
    for turn in range(500):
        matrix = wp.mat33d()
        for i in range(count):
            row = work.rows[i, s]
            at = wp.vec3d(wp.float64(1.0), row[1], row[2])
            if wp.dot(field, at) > zero:
                matrix += row[0] * wp.outer(at, at)
        rest = matrix @ field
        energy = wp.float64(0.5) * wp.dot(field, rest) - wp.dot(field, load)
        rest -= load
        if wp.max(wp.abs(rest)) <= wp.float64(1e-12):
            return field
        least = wp.where(turn < 60, wp.float64(1e-3), wp.float64(1e-8))
        if turn > 0 and energy > value - wp.float64(1e-4) * rate * slope + wp.float64(1e-15) and rate > least:
            rate *= wp.float64(0.5)
            field += rate * step
            continue
        value = energy
        ridge = wp.float64(1e-14) * wp.trace(matrix) + wp.float64(1e-300)
        solved = wp.int32(0)
        for _attempt in range(8):
            if solved == 0:
                raised = matrix + ridge * wp.identity(n=3, dtype=wp.float64)
                determinant = wp.determinant(raised)
                if determinant > zero:
                    step = wp.inverse(raised) @ rest
                    largest = wp.float64(1e3) * (
                        wp.float64(1.0) + wp.abs(field[0]) + wp.abs(field[1]) + wp.abs(field[2])
                    )
                    if wp.max(wp.abs(step)) <= largest:
                        solved = 1
                ridge *= wp.float64(3e4)
        if solved == 0:
            break
        slope = wp.dot(rest, step)
        rate = wp.float64(1.0)
        field -= step
    return wp.vec3d(wp.float64(1.0), zero, zero)  # no pressure has this moment: plain weights


@func
def _share(patch: Patch, work: PatchWork, w: wp.int32, s: wp.int32, place: wp.vec3d, out: wp.vec3d, force: wp.vec3d):
    count = _gather(patch, work, s, place, out)
    if count == 0:
        wp.atomic_add(work.vectors, w, _nearest(patch, place), force)
    total = wp.float64(0.0)
    middle = wp.vec2d()
    for i in range(count):
        row = work.rows[i, s]
        total += row[0]
        middle += row[0] * wp.vec2d(row[1], row[2])
    middle /= wp.max(total, wp.float64(1e-300))
    spread = wp.float64(0.0)
    for i in range(count):
        row = work.rows[i, s]
        off = wp.vec2d(row[1], row[2]) - middle
        spread += row[0] / total * wp.dot(off, off)
    scale = wp.max(wp.sqrt(spread), wp.float64(1e-6))
    for i in range(count):
        row = work.rows[i, s]
        work.rows[i, s] = wp.vec3d(row[0] / total, (row[1] - middle[0]) / scale, (row[2] - middle[1]) / scale)
    at = -middle / scale
    field = wp.vec3d(wp.float64(1.0), wp.float64(0.0), wp.float64(0.0))
    if _surrounded(work, s, count, at):
        field = _tilted(work, s, count, wp.vec3d(wp.float64(1.0), at[0], at[1]))
    total = wp.float64(0.0)
    for i in range(count):
        row = work.rows[i, s]
        part = row[0] * wp.max(field[0] + field[1] * row[1] + field[2] * row[2], wp.float64(0.0))
        work.rows[i, s] = wp.vec3d(part, row[1], row[2])
        total += part
    for i in range(count):
        if work.rows[i, s][0] > wp.float64(0.0):
            wp.atomic_add(work.vectors, w, work.cells[i, s], work.rows[i, s][0] / total * force)


@kernel
def touch(patch: Patch, contacts: Contacts, work: PatchWork):
    """Share each of the `contacts` that touch the `patch` among its cells, into `work`; a thread a contact."""
    i = wp.tid()
    if i >= contacts.count[0]:
        return
    geoms = contacts.geom[i]
    side = side_of(patch.own, geoms)
    if side == 0:
        return
    gap = wp.float64(contacts.dist[i])
    if contacts.address[i, 0] < 0 and gap > patch.reach:
        return
    row = patch.geoms[wp.where(side < 0, geoms[0], geoms[1])]
    w = contacts.world[i]
    frame = wp.transpose(wp.mat33d(contacts.frame[i])) * wp.float64(side)
    turn = wp.mat33d(contacts.xmat[w, patch.body])
    to_patch = wp.transpose(turn @ patch.turn)
    point = to_patch @ (wp.vec3d(contacts.pos[i]) - wp.vec3d(contacts.xpos[w, patch.body]) - turn @ patch.place)
    out = -(to_patch @ (frame @ wp.vec3d(wp.float64(1.0), wp.float64(0.0), wp.float64(0.0))))
    half = wp.float64(0.5) * gap  # a contact's place is halfway between the surfaces
    place = point - half * out
    if not _has(patch, place, _face(patch, row, place, out, wp.abs(half))):
        return
    local, twist = contact_load(contacts, i, w)
    force = to_patch @ (frame @ local)
    moment = to_patch @ (frame @ twist) + wp.cross(point, force)
    for j in range(3):
        wp.atomic_add(work.wrench, w, j, force[j])
        wp.atomic_add(work.wrench, w, 3 + j, moment[j])
    wp.atomic_add(work.load, w, wp.length(force))
    wp.atomic_max(work.extent, w, wp.max(wp.abs(point)))
    _share(patch, work, w, i % work.rows.shape[1], place, out, force)


@kernel
def finish(patch: Patch, work: PatchWork):
    """Set in each world of `work` whether the `patch`'s cells have the contacts' moment; a thread a world."""
    w = wp.tid()
    lost = work.wrench[w, 2] != work.wrench[w, 2]  # diverged: neither in the air nor on the ground
    off = wp.vec3d(work.wrench[w, 3], work.wrench[w, 4], work.wrench[w, 5])
    for i in range(patch.areas.shape[0]):
        off -= wp.cross(patch.positions[i], work.vectors[w, i])
        if lost:
            work.vectors[w, i] = wp.vec3d(work.wrench[w, 2], work.wrench[w, 2], work.wrench[w, 2])
    least = wp.float64(1e-9) * work.load[w] * (work.extent[w] + patch.radius)
    work.carried[w] = wp.where(wp.max(wp.abs(off)) <= least, 1, 0)
