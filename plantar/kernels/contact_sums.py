"""Kernels of sums over contacts: what the ground does to the feet together, and what each pair of geoms carries."""

from __future__ import annotations

__all__ = ["ground_sums", "pair_loads"]


def ground_sums(positions, forces, torques, gaps, carries, reach, sums, points):
    """Add a foot's contacts to the ground's wrench about the world's origin, one after the other.

    Args:
        positions: Contact points (k, 3) in the world in m.
        forces: Forces (k, 3) on the foot in the world in N.
        torques: Torques (k, 3) on the foot in the world in N m.
        gaps: Gaps (k,) in m.
        carries: Whether a contact carries (k,).
        reach: Gap in m up to which a contact counts as a point of support, whether it carries or not.
        sums: Receives, added to what is there (7,): force, torque, and the contacts' height times vertical force.
        points: List that receives the points of support (x, y) in m.
    """
    fx, fy, fz, tx, ty, tz, height = sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6]
    for i in range(positions.shape[0]):
        x, y, z = positions[i, 0], positions[i, 1], positions[i, 2]
        a, b, f = forces[i, 0], forces[i, 1], forces[i, 2]
        fx, fy, fz = fx + a, fy + b, fz + f
        tx = tx + torques[i, 0] + y * f - z * b
        ty = ty + torques[i, 1] + z * a - x * f
        tz = tz + torques[i, 2] + x * b - y * a
        height += z * f
        if carries[i] or gaps[i] <= reach:
            points.append((float(x), float(y)))
    sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6] = fx, fy, fz, tx, ty, tz, height


def pair_loads(own, other, points, forces, torques, gaps, reach):
    """Sum up what each pair of geoms carries, along the normal of a plane and about its axes.

    Args:
        own: Geom (k,) on the foot's side.
        other: Geom (k,) on the other side.
        points: Contact points (k, 3) in a frame with the plane as its z = 0, in m.
        forces: Forces (k, 3) on the foot in that frame in N.
        torques: Torques (k, 3) on the foot in that frame in N m.
        gaps: Gaps (k,) in m.
        reach: Gap in m beyond which a contact that carries nothing is left out.

    Returns:
        For each pair, in the order of its first contact: normal force in N, torques about x and y at the frame's
        origin in N m, and its points (x, y) in m.
    """
    pairs = {}
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        fx, fy, fz = forces[i, 0], forces[i, 1], forces[i, 2]
        if gaps[i] > reach and fz == 0.0:
            continue
        key = (int(own[i]), int(other[i]))
        pair = pairs.get(key)
        if pair is None:
            pair = pairs[key] = [0.0, 0.0, 0.0, []]
        pair[0] += float(fz)
        pair[1] += float(torques[i, 0] + y * fz - z * fy)
        pair[2] += float(torques[i, 1] + z * fx - x * fz)
        pair[3].append((float(x), float(y)))
    return list(pairs.values())
