"""The kernel of a pendulum over a VRP that moves along a line: VRP, DCM and CoM at one time, with their rates.

Plain Python that also compiles ahead of time (`pendulum.pxd` gives the C types). `gait.plan.vrp_plan` is the public
face, with the equations.
"""

from __future__ import annotations

import math

__all__ = ["on_segment"]


def on_segment(omega, since, until, start, rate, growth, shrinkage, out):
    """The pendulum within a segment of its plan.

    Args:
        omega: Pendulum frequency in rad/s.
        since: Time in s since the segment began.
        until: Time in s until it ends.
        start: VRP (2,) at its beginning in m.
        rate: Rate (2,) of the VRP in m/s.
        growth: A e^(w T) (2,) in m.
        shrinkage: B (2,) in m.
        out: Receives VRP, DCM and its rate, CoM and its first and second rate (6, 2).
    """
    grown, shrunk = math.exp(-omega * until), math.exp(-omega * since)
    for axis in range(2):
        vrp, growing, shrinking = start[axis] + since * rate[axis], grown * growth[axis], shrunk * shrinkage[axis]
        out[0, axis] = vrp
        out[1, axis] = vrp + rate[axis] / omega + growing
        out[2, axis] = rate[axis] + omega * growing
        out[3, axis] = vrp + 0.5 * growing + shrinking
        out[4, axis] = rate[axis] + omega * (0.5 * growing - shrinking)
        out[5, axis] = omega * omega * (0.5 * growing + shrinking)
