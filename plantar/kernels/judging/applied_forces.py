"""Whether a simulator's applied forces are those that are known."""

__all__ = ["AppliedForces"]


class AppliedForces:
    """Compares what is applied to n bodies and v joints' axes with what is known.

    Args:
        on_bodies: Forces in N and torques in N m on bodies (n, 6), updated by simulator.
        known: Those that somebody stands for (n, 6), added up by caller for each step.
        on_joints: Forces in N or torques in N m on axes (v,), updated by simulator.
        own: Index (k,) of each axis that is looked at.
        springs: Forces in N or torques in N m (s,) of springs, updated by simulator.
        least: Difference in N or N m up to which they are the same.
    """

    def __init__(self, on_bodies, known, on_joints, own, springs, least):
        self.on_bodies = on_bodies
        self.known = known
        self.on_joints = on_joints
        self.own = own
        self.springs = springs
        self.least = least

    def sprung(self):
        """Whether a spring acts, NaN counting as such."""
        acts = False
        for i in range(self.springs.shape[0]):
            acts = acts or self.springs[i] != 0.0
        return acts

    def unknown(self):
        """Whether anything else is applied, NaN counting as such; otherwise `known` is zero afterwards, for the next
        step.
        """
        for i in range(self.on_bodies.shape[0]):
            for j in range(6):
                if not abs(self.on_bodies[i, j] - self.known[i, j]) <= self.least:
                    return True
        for i in range(self.own.shape[0]):
            if not abs(self.on_joints[self.own[i]]) <= self.least:
                return True
        for i in range(self.on_bodies.shape[0]):
            for j in range(6):
                self.known[i, j] = 0.0
        return False
