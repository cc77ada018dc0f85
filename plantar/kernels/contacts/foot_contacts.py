"""Gathers and sums one foot's contacts from a simulator's list."""

import numpy as np

from ..base import fused, memory

__all__ = ["ContactList", "ContactsInSole", "FeetReader", "FootContacts", "gather_feet"]


class ContactList:
    """Simulator's list of n contacts of all bodies.

    Args:
        geoms: Ids (n, 2) of touching geoms, -1 for none.
        positions: Points (n, 3) in world in m.
        frames: Contact frames (n, 9), axis by axis.
        gaps: Gaps (n,) in m.
        addresses: Index (n,) of each contact's first force; negative without force.
        sizes: Dimensions (n,) of each contact, up to 6.
        friction: Friction (n, 5) of pyramid edges; None for forces along axes.
    """

    def __init__(self, geoms, positions, frames, gaps, addresses, sizes, friction=None):
        self.geoms = geoms
        self.positions = positions
        self.frames = frames
        self.gaps = gaps
        self.addresses = addresses
        self.sizes = sizes
        self.pyramid = friction is not None
        self.friction = np.zeros((1, 5)) if friction is None else friction


def gather_feet(feet, listed, forces):
    """Gather the contacts of several feet. `forces`: forces in N and torques in N m of all contacts."""
    values = memory.values(forces)
    for foot in feet:
        foot._gather(listed, values)


class FeetReader:
    """Gathers the contacts of several feet from a simulation's data after each of its steps.

    Attributes `count`: contacts of all bodies at the last `read`; `feet`, as given.

    Args:
        data: Simulation's data: `ncon` contacts, with `efc_force` of all.
        options: Its options; contacts are listed again where their `cone` changes.
        feet: `FootContacts` of each foot.
        listed: Makes the `ContactList` of the present contacts, which stays valid for their number.
    """

    def __init__(self, data, options, feet, listed):
        self.data = data
        self.options = options
        self.feet = feet
        self.listed = listed
        self.lists = {}
        self.cone = options.cone
        self.count = 0

    def read(self):
        """Each foot's contacts after the last step, in reused objects."""
        count = self.data.ncon
        self.count = count
        if count == 0:
            for foot in self.feet:
                foot.clear()
            return self.feet
        gather_feet(self.feet, self.of_present(count), self.data.efc_force)
        return self.feet

    def of_present(self, count):
        """`ContactList` of so many contacts."""
        cone = self.options.cone
        if cone != self.cone:
            self.cone = cone
            self.lists.clear()
        listed = self.lists.get(count)
        if listed is None:
            listed = self.listed()
            self.lists[count] = listed
        return listed


class FootContacts:
    """One foot's contacts with everything else at each instant.

    `own`: whether geom belongs to foot (geoms,), 0 or 1. Attributes `ids`: foot's geom and the other (room, 2); -1 for
    none; `vectors`: each contact's position in m, force in N and torque in N m on foot (3 room, 3), in world frame;
    `normals`: unit vectors (room, 3) into foot, in world frame, which `take` leaves as they are; `gaps`: gaps (room,)
    in m; `carries`: whether contact carries (room,).
    """

    def __init__(self, own):
        self.own = own
        self.size = 0
        self.room = 0
        self._make_room(8)

    def _make_room(self, room):
        """Room for so many contacts; drops present ones."""
        self.room = room
        self.size = 0
        self.ids = np.empty((room, 2), dtype=np.int32)
        self.vectors = np.empty((3 * room, 3))
        self.normals = np.zeros((room, 3))
        self.gaps = np.empty(room)
        self.carries = np.empty(room, dtype=np.uint8)

    def clear(self):
        """Drop all contacts."""
        self.size = 0

    def take(self, ids, vectors, gaps, carries):
        """Copy contacts: ids (k, 2), vectors (3 k, 3), gaps (k,) and carries (k,)."""
        count = ids.shape[0]
        if count > self.room:
            self._make_room(count)
        for k in range(count):
            self.ids[k, 0] = ids[k, 0]
            self.ids[k, 1] = ids[k, 1]
            self.gaps[k] = gaps[k]
            self.carries[k] = carries[k]
        for k in range(3 * count):
            for j in range(3):
                self.vectors[k, j] = vectors[k, j]
        self.size = count

    def gather(self, listed, forces):
        """Gather the foot's contacts, forces turned from contact frame to world.

        `forces`: forces in N and torques in N m on each second geom.
        """
        self._gather(listed, memory.values(forces))

    def _gather(self, listed, forces):
        count = listed.geoms.shape[0]
        if count > self.room:
            self._make_room(2 * count)
        k = 0
        for i in range(count):
            first = listed.geoms[i, 0]
            second = listed.geoms[i, 1]
            a = self.own[first] if first >= 0 else 0
            b = self.own[second] if second >= 0 else 0
            if a == b:
                continue
            self.ids[k, 0] = second if b else first
            self.ids[k, 1] = first if b else second
            sign = 1.0 if b else -1.0
            row = 3 * k
            for j in range(3):
                self.vectors[row, j] = listed.positions[i, j]
                self.vectors[row + 1, j] = 0.0
                self.vectors[row + 2, j] = 0.0
                self.normals[k, j] = sign * listed.frames[i, j]
            start = listed.addresses[i]
            if start >= 0:
                for m in range(listed.sizes[i]):
                    value = sign * _along(listed, forces, i, m)
                    half = row + 1 if m < 3 else row + 2
                    axis = 3 * (m % 3)
                    for j in range(3):
                        self.vectors[half, j] += value * listed.frames[i, axis + j]
            self.gaps[k] = listed.gaps[i]
            self.carries[k] = start >= 0
            k += 1
        self.size = k

    def from_origin(self, origin, out):
        """Write `vectors`, positions relative to `origin` (3,) in m, to `out` (at least 3 k, 3)."""
        for k in range(self.size):
            row = 3 * k
            for j in range(3):
                out[row, j] = self.vectors[row, j] - origin[j]
                out[row + 1, j] = self.vectors[row + 1, j]
                out[row + 2, j] = self.vectors[row + 2, j]

    def add_to_ground(self, reach, ground, sums, points):
        """Add the contacts to the ground's wrench about the world's origin.

        `reach`: largest gap in m of point of support; `ground`: whether geoms are ground (geoms,); None for all;
        `sums`: force, torque, and sum of height times vertical force (7,), added to.
        """
        fx = sums[0]
        fy = sums[1]
        fz = sums[2]
        tx = sums[3]
        ty = sums[4]
        tz = sums[5]
        height = sums[6]
        for k in range(self.size):
            if ground is not None and self.ids[k, 1] >= 0 and not ground[self.ids[k, 1]]:
                continue
            row = 3 * k
            x = self.vectors[row, 0]
            y = self.vectors[row, 1]
            z = self.vectors[row, 2]
            a = self.vectors[row + 1, 0]
            b = self.vectors[row + 1, 1]
            f = self.vectors[row + 1, 2]
            fx = fx + a
            fy = fy + b
            fz = fz + f
            tx = tx + self.vectors[row + 2, 0] + y * f - z * b
            ty = ty + self.vectors[row + 2, 1] + z * a - x * f
            tz = tz + self.vectors[row + 2, 2] + x * b - y * a
            height += z * f
            if self.carries[k] or self.gaps[k] <= reach:
                points.add(x, y)
        sums[0] = fx
        sums[1] = fy
        sums[2] = fz
        sums[3] = tx
        sums[4] = ty
        sums[5] = tz
        sums[6] = height

    def pair_loads(self, vectors, reach):
        """For each pair of geoms, in order of contact: normal force in N on the plane z = 0, torques about x and y at
        its origin in N m, and points (x, y) in m.

        `vectors`: as attribute, in plane's frame; `reach`: largest gap in m of contact without load.
        """
        loads = []
        points = np.zeros((self.size, 3))
        for k in range(self.size):
            size, force, about_x, about_y = self._pair_load(vectors, reach, k, points)
            if size:
                loads.append([force, about_x, about_y, [(p[0], p[1]) for p in np.asarray(points)[:size].tolist()]])
        return loads

    def _pair_load(self, vectors, reach, k, points):
        """Number of points, force and torques as of `pair_loads` of the pair that contact `k` is the first of, else 0.

        Writes place and overlap of each to `points` (at least k, 3).
        """
        size = 0
        force = 0.0
        about_x = 0.0
        about_y = 0.0
        for j in range(self.size):
            row = 3 * j
            x = vectors[row, 0]
            y = vectors[row, 1]
            z = vectors[row, 2]
            fx = vectors[row + 1, 0]
            fy = vectors[row + 1, 1]
            fz = vectors[row + 1, 2]
            if self.gaps[j] > reach and fz == 0.0:
                if j == k:
                    break
                continue
            if self.ids[j, 0] != self.ids[k, 0] or self.ids[j, 1] != self.ids[k, 1]:
                continue
            if j < k:
                break
            force += fz
            about_x += vectors[row + 2, 0] + y * fz - z * fy
            about_y += vectors[row + 2, 1] + z * fx - x * fz
            points[size, 0] = x
            points[size, 1] = y
            points[size, 2] = -self.gaps[j]
            size += 1
        return size, force, about_x, about_y


def _along(listed, forces, i, m):
    """Loaded contact's force or torque along one axis."""
    start = listed.addresses[i]
    size = listed.sizes[i]
    if not listed.pyramid or size == 1:
        return forces[start + m]
    if m:
        edge = start + 2 * (m - 1)
        return listed.friction[i, m - 1] * (forces[edge] - forces[edge + 1])
    value = 0.0
    for k in range(2 * (size - 1)):
        value += forces[start + k]
    return value


class ContactsInSole:
    """Turns a foot's contacts into its sole frame.

    `vectors`: each contact's position in m, force in N and torque in N m (3 room, 3); `pressed`: how often there were
    contacts; `in_air`: how often there were none; `normals`: unit vectors (room, 3) into foot, only of `turn_normals`.
    """

    def __init__(self):
        self.origin = np.zeros(3)
        self.axes = np.eye(3)
        self.rides = False
        self.pressed = 0
        self.in_air = 0
        self.room = 0
        self._make_room(8)

    def look_from(self, origin, rotation):
        """Set origin (3,) in m and rotation (3, 3) to world of the sole."""
        self.origin = origin
        self.axes = rotation
        self.rides = False

    def ride_on(self, body_place, body_turn, place, seat, origin, axes):
        """Look from a sole that rides on a body, wherever that is at each `look`; contacts are turned without BLAS.

        `body_place` (3,) in m and `body_turn` (9,): the body's pose, which the simulator changes; `place` (3,) in m and
        `seat` (3, 3): the sole's in the body; `origin` (3,) and `axes` (3, 3): receive the sole's in the world.
        """
        self.body_place = body_place
        self.body_turn = body_turn
        self.place = place
        self.seat = seat
        self.own_origin = origin
        self.own_axes = axes
        self.origin = origin
        self.axes = axes
        self.rides = True

    def look(self):
        """Find the pose of the sole on its body now."""
        turn = self.body_turn
        for i in range(3):
            at = self.body_place[i]
            for j in range(3):
                at += turn[3 * i + j] * self.place[j]
                self.own_axes[i, j] = (
                    turn[3 * i] * self.seat[0, j]
                    + turn[3 * i + 1] * self.seat[1, j]
                    + turn[3 * i + 2] * self.seat[2, j]
                )
            self.own_origin[i] = at

    def _make_room(self, room):
        self.room = room
        self.shifted = np.zeros((3 * room, 3))
        self.vectors = np.zeros((3 * room, 3))
        self.normals = np.zeros((room, 3))

    def turn(self, contacts):
        """Turn the current contacts of a foot's `FootContacts`."""
        count = contacts.size
        if count == 0:
            self.in_air += 1
            return
        self.pressed += 1
        if count > self.room:
            self._make_room(2 * count)
        contacts.from_origin(self.origin, self.shifted)
        turn = self.axes
        # Summed in the order of BLAS, whose call took longer than all the rest: what rides on a body never used it.
        if not self.rides and count > 1:
            for k in range(3 * count):
                for j in range(3):
                    self.vectors[k, j] = fused.multiply_add(
                        self.shifted[k, 2],
                        turn[2, j],
                        fused.multiply_add(self.shifted[k, 1], turn[1, j], self.shifted[k, 0] * turn[0, j]),
                    )
        else:
            for k in range(3 * count):
                for j in range(3):
                    self.vectors[k, j] = (
                        self.shifted[k, 0] * turn[0, j]
                        + self.shifted[k, 1] * turn[1, j]
                        + self.shifted[k, 2] * turn[2, j]
                    )

    def turn_normals(self, contacts):
        """Turn the contacts' normals too, of the last `turn`."""
        turn = self.axes
        for k in range(contacts.size):
            for j in range(3):
                self.normals[k, j] = (
                    contacts.normals[k, 0] * turn[0, j]
                    + contacts.normals[k, 1] * turn[1, j]
                    + contacts.normals[k, 2] * turn[2, j]
                )
