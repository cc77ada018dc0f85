"""Kernel of contacts as a simulator lists them: those of one foot, with forces turned into the world frame."""

from __future__ import annotations

__all__ = ["contact_rows"]


def contact_rows(geoms, positions, frames, gaps, addresses, sizes, forces, own, ids, rows):
    """Gather the contacts between a foot's geoms and others.

    A contact's force is given in its own frame, whose rows are its axes, as the force on the second geom: it changes
    sign where the foot is the first. Sums run in the order of the axes, with no error beyond their rounding.

    Args:
        geoms: Ids (n, 2) of the geoms that touch, -1 for what is no geom.
        positions: Contact points (n, 3) in the world in m.
        frames: Contact frames (n, 9), axis by axis.
        gaps: Gaps (n,) in m.
        addresses: Where each contact's numbers begin in `forces` (n,); negative for a contact that carries nothing.
        sizes: How many numbers each contact has (n,), up to 6: force and torque along its axes.
        forces: Forces in N and torques in N m of all contacts.
        own: Whether a geom belongs to the foot, by its id.
        ids: Receives (k, 2): the foot's geom and the other one.
        rows: Receives (k, 11): position, force and torque on the foot in the world, gap, 1 where the contact carries.

    Returns:
        The number k of the foot's contacts.
    """
    k = 0
    for i in range(geoms.shape[0]):
        first, second = geoms[i, 0], geoms[i, 1]
        a = own[first] if first >= 0 else 0
        b = own[second] if second >= 0 else 0
        if a == b:
            continue
        ids[k, 0] = second if b else first
        ids[k, 1] = first if b else second
        sign = 1.0 if b else -1.0
        for j in range(3):
            rows[k, j] = positions[i, j]
            rows[k, 3 + j] = rows[k, 6 + j] = 0.0
        start = addresses[i]
        if start >= 0:
            for m in range(sizes[i]):
                value = sign * forces[start + m]
                half, axis = 3 if m < 3 else 6, 3 * (m % 3)
                for j in range(3):
                    rows[k, half + j] += value * frames[i, axis + j]
        rows[k, 9] = gaps[i]
        rows[k, 10] = 1.0 if start >= 0 else 0.0
        k += 1
    return k
