"""Many readings (frames, n) in N of one `SoleKernel` in one pass, without the interpreter lock.

Forces up to `threshold`, NaN, and from `saturation` on are left out, and all of a sole that `SoleKernel.touches` finds
without contact.
"""

try:
    import cython
except ImportError:
    from plantar.kernels.base import without_cython as cython

__all__ = ["hulls", "loads", "wrenches"]

_INFINITE = float("inf")
_NONE = float("nan")


def wrenches(sole, force, threshold, saturation, out):
    """Wrench (frames, 6) of each frame's active taxels; reference and error as `SoleKernel.loads`.

    Each sum runs over every fourth taxel, to vectorise in unchanged order.
    """
    scratch = sole.borrow()
    with cython.nogil:
        _wrenches(sole, force, threshold, saturation, scratch.kept, out)
    sole.give_back(scratch)


def _wrenches(sole, force, threshold, saturation, kept, out):
    frames = force.shape[0]
    n = sole.taxels
    columns = sole.columns
    lever_x = sole.lever_x
    lever_y = sole.lever_y
    for k in range(frames):
        if not sole.touches(force[k], threshold):
            out[k, :] = 0.0
            continue
        for i in range(n):
            f = force[k, i]
            f = f if f > threshold else 0.0
            kept[i] = f if f < saturation else 0.0
        if sole.flat:
            az = 0.0
            bz = 0.0
            cz = 0.0
            dz = 0.0
            ax = 0.0
            bx = 0.0
            cx = 0.0
            dx = 0.0
            ay = 0.0
            by = 0.0
            cy = 0.0
            dy = 0.0
            for i in range(0, n - 3, 4):
                az += kept[i]
                bz += kept[i + 1]
                cz += kept[i + 2]
                dz += kept[i + 3]
            for i in range(0, n - 3, 4):
                ax += kept[i] * lever_x[i]
                bx += kept[i + 1] * lever_x[i + 1]
                cx += kept[i + 2] * lever_x[i + 2]
                dx += kept[i + 3] * lever_x[i + 3]
            for i in range(0, n - 3, 4):
                ay += kept[i] * lever_y[i]
                by += kept[i + 1] * lever_y[i + 1]
                cy += kept[i + 2] * lever_y[i + 2]
                dy += kept[i + 3] * lever_y[i + 3]
            for i in range(n - n % 4, n):
                az += kept[i]
                ax += kept[i] * lever_x[i]
                ay += kept[i] * lever_y[i]
            out[k, 0] = 0.0
            out[k, 1] = 0.0
            out[k, 5] = 0.0
            out[k, 2] = (az + bz) + (cz + dz)
            out[k, 3] = (ax + bx) + (cx + dx)
            out[k, 4] = (ay + by) + (cy + dy)
        else:
            fx = 0.0
            fy = 0.0
            fz = 0.0
            tx = 0.0
            ty = 0.0
            tz = 0.0
            for i in range(n):
                f = kept[i]
                fx += f * columns[i, 0]
                fy += f * columns[i, 1]
                fz += f * columns[i, 2]
                tx += f * columns[i, 3]
                ty += f * columns[i, 4]
                tz += f * columns[i, 5]
            out[k, 0] = fx
            out[k, 1] = fy
            out[k, 2] = fz
            out[k, 3] = tx
            out[k, 4] = ty
            out[k, 5] = tz


def loads(sole, force, threshold, saturation, out):
    """Wrench, area in m^2 and CoP in m of each frame (frames, 9), equal to `SoleKernel.loads` to the last bit.

    A taxel that is not active adds 0. On a flat sole the moments are those of the CoP.
    """
    scratch = sole.borrow()
    with cython.nogil:
        _loads(sole, force, threshold, saturation, scratch.kept, scratch.covered, out)
    sole.give_back(scratch)


def _loads(sole, force, threshold, saturation, kept, covered, out):
    n = sole.taxels
    columns = sole.columns
    areas = sole.areas
    lever_x = sole.lever_x
    lever_y = sole.lever_y
    for k in range(force.shape[0]):
        if not sole.touches(force[k], threshold):
            out[k, :7] = 0.0
            out[k, 7:] = _NONE
            continue
        for i in range(n):
            f = force[k, i]
            part = areas[i]
            part = part if f > threshold else 0.0
            covered[i] = part if f < saturation else 0.0
            f = f if f > threshold else 0.0
            kept[i] = f if f < saturation else 0.0
        fx = 0.0
        fy = 0.0
        fz = 0.0
        tx = 0.0
        ty = 0.0
        tz = 0.0
        area = 0.0
        sx = 0.0
        sy = 0.0
        if sole.flat:
            for i in range(n):
                fz += kept[i]
                tx += kept[i] * lever_x[i]
                ty += kept[i] * lever_y[i]
                area += covered[i]
            sx = 0.0 - ty
            sy = tx
        else:
            for i in range(n):
                f = kept[i]
                fx += f * columns[i, 0]
                fy += f * columns[i, 1]
                fz += f * columns[i, 2]
                tx += f * columns[i, 3]
                ty += f * columns[i, 4]
                tz += f * columns[i, 5]
                sx += f * columns[i, 6]
                sy += f * columns[i, 7]
                area += covered[i]
        out[k, 0] = fx
        out[k, 1] = fy
        out[k, 2] = fz
        out[k, 3] = tx
        out[k, 4] = ty
        out[k, 5] = tz
        out[k, 6] = area
        if 0.0 < fz < _INFINITE:
            out[k, 7] = sx / fz
            out[k, 8] = sy / fz
        else:
            out[k, 7] = _NONE
            out[k, 8] = _NONE


def hulls(sole, force, threshold, saturation, size, measure, points):
    """Support polygon of each frame, as `SoleKernel.hull`; returns the frames done, fewer if the room is full.

    `size`: receives number of vertices (frames,); `measure`: receives area in m^2 and centroid in m (frames, 3), NaN
    without contact; `points`: receives polygons' vertices (room, 2) in m, in turn; empty if not wanted.
    """
    scratch = sole.borrow()
    with cython.nogil:
        done = _hulls(sole, force, threshold, saturation, scratch, size, measure, points)
    sole.give_back(scratch)
    return done


def _hulls(sole, force, threshold, saturation, scratch, size, measure, points):
    filled = 0
    room = points.shape[0]
    for k in range(force.shape[0]):
        sole.activate(force[k], threshold, saturation, scratch.mask)
        found = sole.find_hull(scratch.mask, scratch)
        if room:
            if filled + found > room:
                return k
            scratch.copy_hull(found, points[filled:])
            filled += found
        size[k] = found
        area, x, y = scratch.measure_hull(found)
        measure[k, 0] = area
        measure[k, 1] = x
        measure[k, 2] = y
    return force.shape[0]
