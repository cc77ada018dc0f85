"""Force on each taxel of a patch that wraps a body: each contact goes to the cells about its own point."""

import math

import numpy as np

from . import pressed_patch

__all__ = ["PatchLoad"]

_CYLINDER = 5  # of mjtGeom
_BOX = 6
_LEVEL = 1e-9  # of a cosine or of a metre: rounding, where a place is on the border of a region
_TRIES = 8  # ridges in a Newton step: a contact that cells lie about on all sides has a pressure of that moment
_EXACT = 1e-9  # of the load times the patch's extent: how exactly the taxels have the moment


class PatchLoad:
    """Shares contacts among the cells of a patch; all places and directions in the patch's frame.

    - A contact is on the face of its geom that its normal points out of; which touches the patch if that face and that
      point belong to the patch's region. Others are not read.
    - The weight of a cell of area A whose axis makes the angle t with the contact's normal, at a distance d: A cos t
      (1 - d^2 / radius^2), none if negative; then w max(0, a + b u + c v), (u, v) across the normal, such that the
      contact's point is the shares' center; plain weights where the point is beyond the cells; the nearest cell where
      none has a weight.
    - Cells have their share of the whole force, normal and tangential, so that forces add up to the contacts'.

    Args:
        positions: Taxels (n, 3) in m.
        normals: Axis (n, 3) of each taxel into body.
        areas: Area (n,) of each cell in m^2.
        radius: Distance in m within which a contact reaches cells.
        rows: Row (geoms,) of each of the model's geoms in what follows; -1 for others.
        kinds: Kind (g,) of each own geom, as MuJoCo numbers them.
        frames: Place, then rotation (g, 12) of each geom.
        sizes: Sizes (g, 3) as MuJoCo has them.
        starts: First plane (g + 1,) of each mesh in `planes`.
        planes: Outward normal and offset (p, 4) of each face of meshes' hulls, in their frames.
        limits: Region (14,): direction and least cosine of normals to it; axis and largest cosine; low and high corner.
        polygon: Outline (m, 2) in m in x and y, any orientation; empty for none.
        turn: Rotation (3, 3) from the patch's frame to that of the box.

    Attributes:
        vectors: Force (n, 3) on each taxel in N.
        forces: Its part (n,) along taxel's axis in N.
        depths: Overlap (n,) of geoms in m.
        wrench: Wrench (6,) of contacts that touch the patch about the origin in N and N m.
        carried: Whether vectors have that wrench, or else only its force.
    """

    def __init__(
        self, positions, normals, areas, radius, rows, kinds, frames, sizes, starts, planes, limits, polygon, turn
    ):
        count = len(areas)
        self.positions = positions
        self.normals = normals
        self.areas = areas
        self.radius = radius
        self.geom_rows = rows
        self.kinds = kinds
        self.frames = frames
        self.sizes = sizes
        self.starts = starts
        self.planes = planes
        self.limits = limits
        self.polygon = polygon
        self.turn = turn
        self.block = pressed_patch.load_block(count)
        self.forces, self.depths, self.vectors, self.wrench = pressed_patch.load_parts(self.block)
        self._forces = self.forces
        self._depths = self.depths
        self._vectors = self.vectors
        self._wrench = self.wrench
        self.rows = np.zeros((max(count, 1), 3))
        self.cells = np.zeros(max(count, 1), dtype=np.int32)
        self.place = np.zeros(3)  # of a contact, on the surface
        self.face = np.zeros(3)  # normal there
        self.local = np.zeros(6)  # place and normal in the geom's frame
        self.carried = True
        self.touched = False

    def clear(self):
        """Set the attributes to those of a patch that nothing touches."""
        for i in range(6):
            self._wrench[i] = 0.0
        for i in range(self.areas.shape[0]):
            self._depths[i] = 0.0
            self._forces[i] = 0.0
            self._vectors[i, 0] = 0.0
            self._vectors[i, 1] = 0.0
            self._vectors[i, 2] = 0.0
        self.carried = True
        self.touched = False

    def is_lost(self):
        """Whether the contacts' load is not a number: the simulation diverged."""
        return self._wrench[2] != self._wrench[2]

    def press(self, contacts, seen, reach):
        """Set the attributes from the body's `FootContacts`, turned by `ContactsInSole`; a contact without load counts
        up to a gap of `reach` in m.
        """
        if self.touched:
            self.clear()
        seen.turn(contacts)
        seen.turn_normals(contacts)
        extent = 0.0
        load = 0.0
        for k in range(contacts.size):
            gap = contacts.gaps[k]
            if not contacts.carries[k] and gap > reach:
                continue
            row = 3 * k
            geom = contacts.ids[k, 0]
            if geom < 0 or self.geom_rows[geom] < 0:
                continue
            # out of the body
            nx = -seen.normals[k, 0]
            ny = -seen.normals[k, 1]
            nz = -seen.normals[k, 2]
            half = 0.5 * gap  # a contact's place is halfway between the surfaces
            x = seen.vectors[row, 0] - half * nx
            y = seen.vectors[row, 1] - half * ny
            z = seen.vectors[row, 2] - half * nz
            self.place[0] = x
            self.place[1] = y
            self.place[2] = z
            self._find_face(self.geom_rows[geom], nx, ny, nz, abs(half))
            if not self._has(x, y, z):
                continue
            self.touched = True
            fx = seen.vectors[row + 1, 0]
            fy = seen.vectors[row + 1, 1]
            fz = seen.vectors[row + 1, 2]
            tx = seen.vectors[row + 2, 0]
            ty = seen.vectors[row + 2, 1]
            tz = seen.vectors[row + 2, 2]
            px = seen.vectors[row, 0]
            py = seen.vectors[row, 1]
            pz = seen.vectors[row, 2]
            self._wrench[0] += fx
            self._wrench[1] += fy
            self._wrench[2] += fz
            self._wrench[3] += tx + py * fz - pz * fy
            self._wrench[4] += ty + pz * fx - px * fz
            self._wrench[5] += tz + px * fy - py * fx
            load += math.sqrt(fx * fx + fy * fy + fz * fz)
            extent = max(extent, abs(px), abs(py), abs(pz))
            self._share(nx, ny, nz, fx, fy, fz, -gap)
        if self.touched:
            self._finish(_EXACT * load * (extent + self.radius))

    def _finish(self, least):
        """Set the forces along the taxels' axes, and whether the moment is the contacts'."""
        mx = self._wrench[3]
        my = self._wrench[4]
        mz = self._wrench[5]
        for i in range(self.areas.shape[0]):
            fx = self._vectors[i, 0]
            fy = self._vectors[i, 1]
            fz = self._vectors[i, 2]
            self._forces[i] = fx * self.normals[i, 0] + fy * self.normals[i, 1] + fz * self.normals[i, 2]
            mx -= self.positions[i, 1] * fz - self.positions[i, 2] * fy
            my -= self.positions[i, 2] * fx - self.positions[i, 0] * fz
            mz -= self.positions[i, 0] * fy - self.positions[i, 1] * fx
        self.carried = abs(mx) <= least and abs(my) <= least and abs(mz) <= least

    def _find_face(self, row, nx, ny, nz, slack):
        """Set `face` to the normal of a geom's face at `place` that points most along the contact's normal.

        What is round has the contact's own; `slack`: how far in m the place may be off.
        """
        kind = self.kinds[row]
        face = self.face
        face[0] = nx
        face[1] = ny
        face[2] = nz
        if kind < _CYLINDER:  # a sphere, capsule or ellipsoid
            return
        f = self.frames
        local = self.local
        x = self.place[0] - f[row, 0]
        y = self.place[1] - f[row, 1]
        z = self.place[2] - f[row, 2]
        for j in range(3):
            local[j] = f[row, 3 + j] * x + f[row, 6 + j] * y + f[row, 9 + j] * z
            local[3 + j] = f[row, 3 + j] * nx + f[row, 6 + j] * ny + f[row, 9 + j] * nz
        s = self.sizes
        best = -2.0
        bx = 0.0
        by = 0.0
        bz = 0.0
        for attempt in range(2):  # then any face, if none is near
            far = (slack + 1e-3 * (s[row, 0] + s[row, 1] + s[row, 2])) if attempt == 0 else 1e300
            if kind == _BOX:
                for j in range(3):
                    sign = 1.0 if local[3 + j] > 0.0 else -1.0
                    along = abs(local[3 + j])
                    if s[row, j] - sign * local[j] <= far and along > best + _LEVEL:
                        best = along
                        bx = sign if j == 0 else 0.0
                        by = sign if j == 1 else 0.0
                        bz = sign if j == 2 else 0.0
            elif kind == _CYLINDER:
                wide = math.sqrt(local[0] * local[0] + local[1] * local[1])
                if s[row, 0] - wide <= far and wide > 0.0:
                    best = (local[3] * local[0] + local[4] * local[1]) / wide
                    bx = local[0] / wide
                    by = local[1] / wide
                    bz = 0.0
                sign = 1.0 if local[5] > 0.0 else -1.0
                if s[row, 1] - sign * local[2] <= far and abs(local[5]) > best + _LEVEL:
                    best = abs(local[5])
                    bx = 0.0
                    by = 0.0
                    bz = sign
            else:
                for p in range(self.starts[row], self.starts[row + 1]):
                    a = self.planes[p, 0]
                    b = self.planes[p, 1]
                    c = self.planes[p, 2]
                    along = a * local[3] + b * local[4] + c * local[5]
                    if (
                        along > best + _LEVEL
                        and self.planes[p, 3] - (a * local[0] + b * local[1] + c * local[2]) <= far
                    ):
                        best = along
                        bx = a
                        by = b
                        bz = c
            if best > 0.0:
                break
        if best > 0.0:
            for j in range(3):
                face[j] = f[row, 3 + 3 * j] * bx + f[row, 4 + 3 * j] * by + f[row, 5 + 3 * j] * bz

    def _has(self, x, y, z):
        """Whether the patch's region has this place, with `face` as its normal."""
        r = self.limits
        face = self.face
        if r[0] * face[0] + r[1] * face[1] + r[2] * face[2] < r[3] - _LEVEL:
            return False
        if abs(r[4] * face[0] + r[5] * face[1] + r[6] * face[2]) > r[7] + _LEVEL:
            return False
        for j in range(3):
            at = self.turn[j, 0] * x + self.turn[j, 1] * y + self.turn[j, 2] * z
            if at < r[8 + j] - _LEVEL or at > r[11 + j] + _LEVEL:
                return False
        count = self.polygon.shape[0]
        if count == 0:
            return True
        inside = False
        for i in range(count):
            j = i - 1 if i > 0 else count - 1
            ay = self.polygon[i, 1]
            by = self.polygon[j, 1]
            if (ay > y) != (by > y):
                at = (self.polygon[j, 0] - self.polygon[i, 0]) * (y - ay) / (by - ay) + self.polygon[i, 0]
                if x < at:
                    inside = not inside
        return inside

    def _share(self, nx, ny, nz, fx, fy, fz, depth):
        """Add a contact's force to cells about `place`."""
        rows = self.rows
        count = self._gather(nx, ny, nz)
        if count == 0:
            self._add(self._nearest(), 1.0, fx, fy, fz, depth)
            return
        cu, cv, scale = pressed_patch._centred(rows, count, 1e-6)
        found = False
        a = 1.0
        b = 0.0
        c = 0.0
        if _surrounded(rows, count, -cu / scale, -cv / scale):
            found, a, b, c = pressed_patch._tilted(rows, count, -cu / scale, -cv / scale, _TRIES)
        if not found:
            a = 1.0
            b = 0.0
            c = 0.0
        shared = 0.0
        for i in range(count):
            part = a + b * rows[i, 1] + c * rows[i, 2]
            part = rows[i, 0] * part if part > 0.0 else 0.0
            rows[i, 0] = part
            shared += part
        for i in range(count):
            if rows[i, 0] > 0.0:
                self._add(self.cells[i], rows[i, 0] / shared, fx, fy, fz, depth)

    def _gather(self, nx, ny, nz):
        """Put weight and place across the normal of each cell that reaches `place` into `rows`; their number."""
        # Two directions across the normal.
        if abs(nx) < 0.6:
            ux = 0.0
            uy = nz
            uz = -ny
        else:
            ux = -nz
            uy = 0.0
            uz = nx
        length = math.sqrt(ux * ux + uy * uy + uz * uz)
        ux /= length
        uy /= length
        uz /= length
        vx = ny * uz - nz * uy
        vy = nz * ux - nx * uz
        vz = nx * uy - ny * ux
        square = self.radius * self.radius
        count = 0
        for i in range(self.areas.shape[0]):
            dx = self.positions[i, 0] - self.place[0]
            dy = self.positions[i, 1] - self.place[1]
            dz = self.positions[i, 2] - self.place[2]
            away = dx * dx + dy * dy + dz * dz
            if away >= square:
                continue
            facing = self._facing(i, nx, ny, nz)
            if facing > _LEVEL:
                self.rows[count, 0] = self.areas[i] * facing * (1.0 - away / square)
                self.rows[count, 1] = ux * dx + uy * dy + uz * dz
                self.rows[count, 2] = vx * dx + vy * dy + vz * dz
                self.cells[count] = i
                count += 1
        return count

    def _nearest(self):
        """The cell nearest `place`."""
        nearest = 0
        least = 1e300
        for i in range(self.areas.shape[0]):
            dx = self.positions[i, 0] - self.place[0]
            dy = self.positions[i, 1] - self.place[1]
            dz = self.positions[i, 2] - self.place[2]
            away = dx * dx + dy * dy + dz * dz
            if away < least:
                least = away
                nearest = i
        return nearest

    def _facing(self, i, nx, ny, nz):
        """Cosine of the angle between a cell's outward axis and a contact's normal."""
        return -(self.normals[i, 0] * nx + self.normals[i, 1] * ny + self.normals[i, 2] * nz)

    def _add(self, i, share, fx, fy, fz, depth):
        self._vectors[i, 0] += share * fx
        self._vectors[i, 1] += share * fy
        self._vectors[i, 2] += share * fz
        if depth > self._depths[i]:
            self._depths[i] = depth


def _surrounded(rows, count, x, y):
    """Whether places (u, v) of the first rows lie on all sides of (x, y), or one on it: their hull has it inside.

    Each gap between directions to neighbours in angle is below half a turn: no direction has all on one side.
    """
    for i in range(count):
        px = rows[i, 1] - x
        py = rows[i, 2] - y
        if px * px + py * py < 1e-18:
            return True
        left = False
        right = False
        # Some place is strictly to the left of the ray through i, or else i is on an edge with the point outside.
        for j in range(count):
            cross = px * (rows[j, 2] - y) - py * (rows[j, 1] - x)
            ahead = px * (rows[j, 1] - x) + py * (rows[j, 2] - y)
            if cross > 1e-9:
                left = True
            if cross < -1e-9:
                right = True
            if abs(cross) <= 1e-9 and ahead < 0.0:
                left = True
                right = True
        if not left or not right:
            return False
    return count > 0
