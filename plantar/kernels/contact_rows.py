"""Kernels of contacts as a simulator lists them: those of each foot, with forces turned into the world frame."""

from __future__ import annotations

__all__ = ["contact_rows"]


def contact_rows(geoms, positions, frames, gaps, addresses, sizes, forces, own, ids, rows, carries):
    """Gather the contacts between each foot's geoms and others, foot after foot.

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
        own: Whether a geom belongs to a foot (feet, geoms).
        ids: Receives the foot's geom and the other one (k, 2), k up to n a foot.
        rows: Receives position, force and torque on the foot in the world, gap (k, 10).
        carries: Receives whether a contact carries (k,).

    Returns:
        Where in what was received each foot's contacts begin, and where the last one's end (feet + 1,).
    """
    k = 0
    ends = [0]
    for foot in range(own.shape[0]):
        for i in range(geoms.shape[0]):
            first, second = geoms[i, 0], geoms[i, 1]
            a = own[foot, first] if first >= 0 else 0
            b = own[foot, second] if second >= 0 else 0
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
            carries[k] = start >= 0
            k += 1
        ends.append(k)
    return ends
