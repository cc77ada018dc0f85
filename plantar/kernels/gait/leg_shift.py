"""What swinging legs take from the pendulum that is planned, measured and balanced, and give back to the body.

Their angular momentum counts as a shift of the plan (`plantar.gait.plan.leg_momentum`).
"""

from ..base import memory, vectors

__all__ = ["accelerations", "added", "dcms"]


def accelerations(reference, shift, inertia):
    """CoM's (2,) planned with swinging legs, and the swinging foot's (2,) that their `shift` is of, in m/s^2.

    `reference`: plan without them; `inertia`: D in s^2 of a leg, above 0.
    """
    com = memory.values(reference.com_acceleration)
    legs = memory.values(shift.com_acceleration)
    vrp = memory.values(shift.vrp)
    return vectors.vector2(com[0] + legs[0], com[1] + legs[1]), vectors.vector2(vrp[0] / -inertia, vrp[1] / -inertia)


def dcms(state, shift, omega):
    """A state's DCM (2,) in m (T 4.27), and that without the legs' `shift`.

    `state`: with CoM in m and its velocity in m/s; `omega`: pendulum's frequency in rad/s.
    """
    com = memory.values(state.com)
    velocity = memory.values(state.com_velocity)
    legs = memory.values(shift.dcm)
    x = com[0] + velocity[0] / omega
    y = com[1] + velocity[1] / omega
    return vectors.vector2(x, y), vectors.vector2(x - legs[0], y - legs[1])


def added(com, acceleration, shift, inertia):
    """A pendulum's `com` (2,) in m and `acceleration` (2,) in m/s^2 with the legs' `shift`, and (-L_y', L_x') / (m g)
    (2,) in m, L the angular momentum about the CoM. `inertia`: D in s^2 of a leg.
    """
    place = memory.values(com)
    rate = memory.values(acceleration)
    legs = memory.values(shift.com)
    more = memory.values(shift.com_acceleration)
    vrp = memory.values(shift.vrp)
    x = rate[0] + more[0]
    y = rate[1] + more[1]
    both = 2.0 * inertia
    return (
        vectors.vector2(place[0] + legs[0], place[1] + legs[1]),
        vectors.vector2(x, y),
        vectors.vector2(-vrp[0] - both * x, -vrp[1] - both * y),
    )
