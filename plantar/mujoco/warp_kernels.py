# mypy: ignore-errors
"""`plantar.kernels.contacts.taxel_load` for many worlds by NVIDIA Warp, a thread a world.

Numbers are float64, from MuJoCo Warp's float32 contacts. `wp.int32(0)` declares a variable that a loop changes.
"""

from __future__ import annotations

try:
    import warp as wp
except ImportError:  # then the functions are not called
    wp = None


def _as_it_is(function):
    return function


func, kernel, struct = 3 * (_as_it_is,) if wp is None else (wp.func, wp.kernel, wp.struct)
if wp is not None:
    wp.set_module_options({"enable_backward": False})  # half of the time to compile


@struct
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


@struct
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
    adhesion: wp.array(dtype=wp.float32)
    force: wp.array2d(dtype=wp.float32)
    xpos: wp.array2d(dtype=wp.vec3f)
    xmat: wp.array2d(dtype=wp.mat33f)
    elliptic: wp.bool


@struct
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


@func
def _row(contacts: Contacts, i: wp.int32, j: wp.int32, world: wp.int32) -> wp.float64:
    if contacts.address[i, j] < 0:  # dropped for want of room
        return wp.float64(0.0)
    return wp.float64(contacts.force[world, contacts.address[i, j]])


@func
def contact_load(contacts: Contacts, i: wp.int32, world: wp.int32):
    """Force and torque of a contact on its second geom, less adhesion; contact frame."""
    local = wp.vec3d()
    twist = wp.vec3d()
    if contacts.address[i, 0] >= 0:
        dim = contacts.dim[i]
        for j in range(dim):
            value = wp.float64(0.0)
            if contacts.elliptic or dim == 1:
                value = _row(contacts, i, j, world)
            elif j > 0:
                plus = _row(contacts, i, 2 * j - 2, world)
                minus = _row(contacts, i, 2 * j - 1, world)
                local[0] += plus + minus
                value = (plus - minus) * wp.float64(contacts.friction[i, j - 1])
            if j < 3:
                local[j] += value
            else:
                twist[j - 3] = value
        if contacts.adhesion:
            local[0] -= wp.float64(contacts.adhesion[i])
    return local, twist


@func
def side_of(own: wp.array(dtype=wp.int32), geoms: wp.vec2i) -> wp.int32:
    """Which of two geoms alone is a skin's own: -1 for the first, 1 for the second, 0 for both or none."""
    first = geoms[0] >= 0 and own[wp.max(geoms[0], 0)] != 0  # -1 is a flex
    second = geoms[1] >= 0 and own[wp.max(geoms[1], 0)] != 0
    if first == second:
        return 0
    return wp.where(first, -1, 1)


@kernel
def gather(sole: Sole, contacts: Contacts, work: Work):
    """Add each of the `contacts` to the lists of the `sole` in `work`, in its frame; a thread a contact."""
    i = wp.tid()
    if i >= contacts.count[0]:
        return
    geoms = contacts.geom[i]
    side = side_of(sole.own, geoms)
    if side == 0:
        return
    world = contacts.world[i]
    k = wp.atomic_add(work.size, world, 1)
    if k >= work.gap.shape[0]:
        return
    local, twist = contact_load(contacts, i, world)
    turn = wp.mat33d(contacts.xmat[world, sole.body])
    to_sole = wp.transpose(turn @ sole.turn)
    origin = wp.vec3d(contacts.xpos[world, sole.body]) + turn @ sole.place
    axes = wp.transpose(wp.mat33d(contacts.frame[i])) * wp.float64(side)
    work.pair[k, world] = geoms
    work.gap[k, world] = wp.float64(contacts.dist[i])
    work.at[k, world] = to_sole @ (wp.vec3d(contacts.pos[i]) - origin)
    work.force[k, world] = to_sole @ (axes @ local)
    work.torque[k, world] = to_sole @ (axes @ twist)


@func
def _counts(sole: Sole, work: Work, w: wp.int32, k: wp.int32) -> wp.bool:
    return work.gap[k, w] <= sole.reach or work.force[k, w][2] != wp.float64(0.0)


@func
def _join(work: Work, s: wp.int32, corners: wp.int32, floor: wp.int32, p: wp.vec2d) -> wp.int32:
    while corners - floor >= 2:
        a = work.ring[corners - 1, s] - work.ring[corners - 2, s]
        b = p - work.ring[corners - 2, s]
        if a[0] * b[1] - a[1] * b[0] > wp.float64(0.0):
            break
        corners -= 1
    if corners > 0 and work.ring[corners - 1, s] == p:
        return corners
    work.ring[corners, s] = p
    return corners + 1


@func
def _hull_of(work: Work, s: wp.int32, size: wp.int32) -> wp.int32:
    for k in range(1, size):
        p = work.points[k, s] + wp.vec3d()  # a copy, not a reference
        j = k
        while j > 0:
            q = work.points[j - 1, s]
            if not (q[0] > p[0] or (q[0] == p[0] and q[1] > p[1])):
                break
            work.points[j, s] = q
            j -= 1
        work.points[j, s] = p
    corners = wp.int32(0)
    for k in range(size):
        corners = _join(work, s, corners, 0, wp.vec2d(work.points[k, s][0], work.points[k, s][1]))
    floor = corners - 1
    for i in range(size - 1):
        p = work.points[size - 2 - i, s]
        corners = _join(work, s, corners, floor, wp.vec2d(p[0], p[1]))
    return corners - wp.where(corners > 1, 1, 0)


@func
def _distance(work: Work, s: wp.int32, corners: wp.int32, p: wp.vec2d) -> wp.float64:
    deepest = wp.float64(-1e300)
    for k in range(corners):
        e = work.edges[k, s]
        off = p - work.ring[k, s]
        deepest = wp.max(deepest, e[1] * off[0] - e[0] * off[1])
    if corners >= 3 and deepest <= wp.float64(0.0):
        return deepest
    nearest = wp.float64(1e300)
    for k in range(corners):
        edge = work.edges[k, s]
        way = wp.vec2d(edge[0], edge[1])
        away = p - work.ring[k, s]
        away -= wp.clamp(wp.dot(way, away), wp.float64(0.0), edge[2]) * way
        nearest = wp.min(nearest, wp.dot(away, away))
    return wp.sqrt(nearest)


@func
def _cover(sole: Sole, work: Work, s: wp.int32, size: wp.int32):
    corners = _hull_of(work, s, size)
    for k in range(corners):
        way = work.ring[(k + 1) % corners, s] - work.ring[k, s]
        length = wp.length(way)
        way /= wp.max(length, wp.float64(1e-300))  # a single point has none
        work.edges[k, s] = wp.vec3d(way[0], way[1], length)
    half = wp.float64(0.5)
    least = wp.float64(1e300)
    for i in range(sole.areas.shape[0]):
        gap = _distance(work, s, corners, wp.vec2d(sole.positions[i][0], sole.positions[i][1]))
        work.gaps[i, s] = gap
        least = wp.min(least, gap - half * sole.widths[i])
    shift = wp.max(least, wp.float64(0.0))
    for i in range(sole.areas.shape[0]):
        gap = (work.gaps[i, s] - shift) / sole.widths[i]
        share = wp.clamp(half - half * gap, wp.float64(0.0), wp.float64(1.0))
        if gap < wp.float64(2.0):
            share += wp.float64(0.02) * (wp.float64(1.0) - half * wp.max(gap, wp.float64(0.0)))
        work.weights[i, s] = sole.areas[i] * share


@func
def _is_beyond(sole: Sole, at: wp.vec2d) -> wp.bool:
    corners = sole.hull.shape[0]
    for k in range(corners):
        way = sole.hull[(k + 1) % corners] - sole.hull[k]
        off = at - sole.hull[k]
        if way[0] * off[1] - way[1] * off[0] < -wp.float64(1e-12) * wp.length(way):  # m: rounding
            return True
    return False


@func
def _tilt(
    sole: Sole, work: Work, weights: wp.array2d(dtype=wp.float64), s: wp.int32, force: wp.float64, at: wp.vec2d
) -> wp.bool:
    zero = wp.float64(0.0)
    one = wp.float64(1.0)
    total = wp.float64(0.0)
    middle = wp.vec2d()
    for i in range(sole.areas.shape[0]):
        total += weights[i, s]
        middle += weights[i, s] * wp.vec2d(sole.positions[i][0], sole.positions[i][1])
    if total <= zero or _is_beyond(sole, at):
        return False
    middle /= total
    spread = wp.float64(0.0)
    for i in range(sole.areas.shape[0]):
        off = wp.vec2d(sole.positions[i][0], sole.positions[i][1]) - middle
        spread += weights[i, s] * wp.dot(off, off)
    scale = wp.max(wp.sqrt(spread / total), wp.float64(1e-4))
    for i in range(sole.areas.shape[0]):
        off = (wp.vec2d(sole.positions[i][0], sole.positions[i][1]) - middle) / scale
        work.rows[i, s] = wp.vec3d(one, off[0], off[1])
    off = (at - middle) / scale
    load = wp.vec3d(one, off[0], off[1])
    field = wp.vec3d(one, zero, zero)
    step = wp.vec3d()
    slope = wp.float64(0.0)
    value = wp.float64(0.0)
    rate = wp.float64(1.0)
    for turn in range(60):
        matrix = wp.mat33d()
        for i in range(sole.areas.shape[0]):
            row = work.rows[i, s]
            if weights[i, s] > zero and wp.dot(field, row) > zero:
                matrix += (weights[i, s] / total) * wp.outer(row, row)
        rest = matrix @ field
        energy = wp.float64(0.5) * wp.dot(field, rest) - wp.dot(field, load)
        rest -= load
        if wp.max(wp.max(wp.abs(rest[0]), wp.abs(rest[1])), wp.abs(rest[2])) <= wp.float64(1e-12):
            for i in range(sole.areas.shape[0]):
                pressure = wp.max(wp.dot(field, work.rows[i, s]), zero)
                work.normal[i, s] = force * weights[i, s] / total * pressure
            return True
        too_far = energy > value - wp.float64(1e-4) * rate * slope + wp.float64(1e-15)
        if turn > 0 and too_far and rate > wp.float64(1e-3):
            rate *= wp.float64(0.5)
            field += rate * step
            continue
        value = energy
        ridge = wp.float64(1e-14) * wp.trace(matrix) + wp.float64(1e-300)
        solved = False
        for _attempt in range(3):
            if not solved:
                raised = matrix + ridge * wp.identity(n=3, dtype=wp.float64)
                step = wp.inverse(raised) @ rest
                largest = wp.float64(1e3) * (one + wp.abs(field[0]) + wp.abs(field[1]) + wp.abs(field[2]))
                solved = wp.determinant(raised) > zero and wp.max(wp.abs(step)) <= largest
                ridge *= wp.float64(3e4)
        if not solved:
            return False
        slope = wp.dot(rest, step)
        rate = wp.float64(1.0)
        field -= step
    return False


@func
def _even(sole: Sole, work: Work, s: wp.int32, force: wp.float64):
    total = wp.float64(0.0)
    for i in range(sole.areas.shape[0]):
        total += work.weights[i, s]
    for i in range(sole.areas.shape[0]):
        work.normal[i, s] = force * work.weights[i, s] / total


@func
def _spread_pairs(sole: Sole, work: Work, w: wp.int32, s: wp.int32, count: wp.int32):
    for k in range(count):
        known = not _counts(sole, work, w, k)
        for j in range(k):
            if work.pair[j, w] == work.pair[k, w] and _counts(sole, work, w, j):
                known = True
        if not known:
            force = wp.float64(0.0)
            about = wp.vec2d()
            size = wp.int32(0)
            for j in range(k, count):
                if work.pair[j, w] == work.pair[k, w] and _counts(sole, work, w, j):
                    at = work.at[j, w]
                    f = work.force[j, w]
                    moment = work.torque[j, w] + wp.cross(at, f)
                    force += f[2]
                    about += wp.vec2d(moment[0], moment[1])
                    work.points[size, s] = wp.vec3d(at[0], at[1], -work.gap[j, w])
                    size += 1
            if force > wp.float64(0.0):
                _cover(sole, work, s, size)
                place = wp.vec2d(-about[1] / force, about[0] / force)
                if not _tilt(sole, work, work.weights, s, force, place):
                    _even(sole, work, s, force)
                for i in range(sole.areas.shape[0]):
                    work.prior[i, s] += work.normal[i, s]


@func
def _nearest(sole: Sole, p: wp.vec2d) -> wp.vec2d:
    best = wp.float64(1e300)
    found = wp.vec2d(p[0], p[1])
    corners = sole.hull.shape[0]
    for k in range(corners):
        way = sole.hull[(k + 1) % corners] - sole.hull[k]
        off = p - sole.hull[k]
        square = wp.max(wp.dot(way, way), wp.float64(1e-300))
        along = wp.clamp(wp.dot(way, off) / square, wp.float64(0.0), wp.float64(1.0))
        away = off - along * way
        if wp.dot(away, away) < best:
            best = wp.dot(away, away)
            found = sole.hull[k] + along * way
    return found


@func
def _carry(sole: Sole, work: Work, s: wp.int32, force: wp.float64, at: wp.vec2d) -> wp.bool:
    zero = wp.float64(0.0)
    count = sole.areas.shape[0]
    first = wp.where(_is_beyond(sole, at), 1, 0)
    if _tilt(sole, work, work.prior, s, force, at):
        return True
    for stage in range(first, 2):
        area = wp.float64(0.0)
        for i in range(count):
            work.gaps[i, s] = sole.areas[i] * wp.float64(stage)
            if stage == 0:
                for j in range(count):
                    off = sole.positions[i] - sole.positions[j]
                    reach = wp.float64(4.0) * sole.widths[j] * sole.widths[j]
                    if work.prior[j, s] > zero and off[0] * off[0] + off[1] * off[1] < reach:
                        work.gaps[i, s] = sole.areas[i]
            area += work.gaps[i, s]
        for i in range(count):
            prior = work.prior[i, s] * wp.float64(1 - first)
            work.weights[i, s] = prior + wp.float64(1e-3) * force * work.gaps[i, s] / area
        if _tilt(sole, work, work.weights, s, force, at):
            return True
    inside = wp.vec2d()
    for k in range(sole.hull.shape[0]):
        inside += sole.hull[k] / wp.float64(sole.hull.shape[0])
    near_by = _nearest(sole, at)
    for _ in range(20):
        near_by += wp.float64(1e-3) * (inside - near_by)
        if _tilt(sole, work, work.weights, s, force, near_by):
            return False
    _even(sole, work, s, force)
    return False


@func
def _shear(sole: Sole, work: Work, w: wp.int32, s: wp.int32, force: wp.vec3d, about_z: wp.float64) -> wp.bool:
    middle = wp.vec2d()
    spread = wp.float64(0.0)
    turn = wp.float64(0.0)
    for i in range(sole.areas.shape[0]):
        middle += work.normal[i, s] / force[2] * wp.vec2d(sole.positions[i][0], sole.positions[i][1])
    for i in range(sole.areas.shape[0]):
        off = wp.vec2d(sole.positions[i][0], sole.positions[i][1]) - middle
        spread += work.normal[i, s] * wp.dot(off, off)
    twist = about_z - (middle[0] * force[1] - middle[1] * force[0])
    holds = True
    if spread > wp.float64(1e-12) * force[2]:
        turn = twist / spread
    elif wp.abs(twist) > wp.float64(1e-12) * force[2]:
        holds = False
    for i in range(sole.areas.shape[0]):
        n = work.normal[i, s]
        share = work.normal[i, s] / force[2]
        off = wp.vec2d(sole.positions[i][0], sole.positions[i][1]) - middle
        work.vectors[w, i] = wp.vec3d(share * force[0] - turn * n * off[1], share * force[1] + turn * n * off[0], n)
    return holds


@kernel
def press(sole: Sole, work: Work):
    """Spread each world's contact wrench over the taxels; a thread a world.

    `work` has the lists of `gather` for the `sole` and receives forces, wrench and whether it is carried.
    """
    w = wp.tid()
    s = w % work.prior.shape[1]
    count = wp.min(work.size[w], work.gap.shape[0])
    back_force = wp.vec3d()
    back_moment = wp.vec3d()
    force = wp.vec3d()
    moment = wp.vec3d()
    holds = work.size[w] <= count
    for k in range(count):
        f = work.force[k, w] + wp.vec3d()  # a copy, not a reference
        m = work.torque[k, w] + wp.cross(work.at[k, w], f)
        if f[2] < wp.float64(0.0) and f[2] * f[2] > f[0] * f[0] + f[1] * f[1]:
            holds = False
            back_force += f
            back_moment += m
            work.force[k, w] = wp.vec3d()
            work.torque[k, w] = wp.vec3d()
        else:
            force += f
            moment += m
    for j in range(3):
        work.wrench[w, j] = force[j] + back_force[j]
        work.wrench[w, 3 + j] = moment[j] + back_moment[j]
    for i in range(sole.areas.shape[0]):
        work.prior[i, s] = wp.float64(0.0)
        work.vectors[w, i] = force - force  # 0, or NaN where the world diverged
    if not force[2] > wp.float64(0.0):
        work.carried[w] = wp.where(holds and wp.length(force) + wp.length(moment) == wp.float64(0.0), 1, 0)
        return
    carried = wp.int32(1)
    _spread_pairs(sole, work, w, s, count)
    about = wp.vec2d(moment[0], moment[1])
    for _ in range(60):
        if not _carry(sole, work, s, force[2], wp.vec2d(-about[1] / force[2], about[0] / force[2])):
            carried = wp.int32(0)
        if not _shear(sole, work, w, s, force, moment[2]):
            carried = wp.int32(0)
        if sole.level:
            break
        off = wp.vec2d(moment[0], moment[1])
        for i in range(sole.areas.shape[0]):
            turned = wp.cross(sole.positions[i], work.vectors[w, i])
            off -= wp.vec2d(turned[0], turned[1])
        if carried == 0 or wp.max(wp.abs(off[0]), wp.abs(off[1])) <= wp.float64(1e-12) * force[2]:
            break
        about += off
    work.carried[w] = wp.where(holds, carried, 0)


@kernel
def share(shares: wp.array2d(dtype=wp.float64), vectors: wp.array2d(dtype=wp.vec3d), out: wp.array2d(dtype=wp.vec3d)):
    """Share forces as an elastic layer does, from `vectors` to `out`; a thread a world and cell."""
    w, i = wp.tid()
    force = wp.vec3d()
    for j in range(shares.shape[0]):
        force += shares[i, j] * vectors[w, j]
    out[w, i] = force


@kernel
def check_moment(
    positions: wp.array(dtype=wp.vec3d),
    wrench: wp.array2d(dtype=wp.float64),
    vectors: wp.array2d(dtype=wp.vec3d),
    carried: wp.array(dtype=wp.int32),
):
    """Clear `carried` where shared forces have not the contacts' moment to 1e-9 of load times extent."""
    w = wp.tid()
    off = wp.vec3d(-wrench[w, 3], -wrench[w, 4], -wrench[w, 5])
    load = wp.float64(0.0)
    extent = wp.float64(0.0)
    for i in range(positions.shape[0]):
        f = vectors[w, i]
        p = positions[i]
        off += wp.cross(p, f)
        load += wp.abs(f[0]) + wp.abs(f[1]) + wp.abs(f[2])
        extent = wp.max(extent, wp.max(wp.abs(p[0]), wp.max(wp.abs(p[1]), wp.abs(p[2]))))
    if wp.max(wp.abs(off[0]), wp.max(wp.abs(off[1]), wp.abs(off[2]))) > wp.float64(1e-9) * load * extent:
        carried[w] = 0
