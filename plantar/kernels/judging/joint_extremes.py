"""Joint speeds both ways, and time at limits."""

import numpy as np

__all__ = ["JointExtremes"]


class JointExtremes:
    """Follows k joints, physics step by physics step.

    `speeds`: speeds (n,) of all joints in rad/s, updated by simulator; `places` (k,) joints' indices there;
    `per_speed`: one over each joint's speed limit (k,) in s/rad; 0 for none; `torques`: torques (m,) of all servos in N
    m, likewise; `servos` (k,) joints' indices there; `per_torque`: one over each joint's torque limit (k,) in 1/(N m);
    0 for none. Attributes `high`: largest speed (k,) in rad/s, 0 at least; `low` the least one, 0 at most; `longest`:
    most steps in a row (k,) above speed limit; `held`: steps (k,) at torque limit; `any_held` those of any joint.
    """

    def __init__(self, speeds, places, per_speed, torques, servos, per_torque):
        count = len(places)
        self.speeds = speeds
        self.places = places
        self.per_speed = per_speed
        self.torques = torques
        self.servos = servos
        self.per_torque = per_torque
        self.steps = 0
        self.any_held = 0
        self.high = np.zeros(count)
        self.low = np.zeros(count)
        self.over = np.zeros(count, dtype=np.intp)
        self.longest = np.zeros(count, dtype=np.intp)
        self.held = np.zeros(count, dtype=np.intp)

    def step(self):
        """Add present speeds and torques; NaN counts as beyond."""
        self.steps += 1
        any_held = False
        for i in range(self.places.shape[0]):
            speed = self.speeds[self.places[i]]
            if not speed <= self.high[i]:
                self.high[i] = speed
            if not speed >= self.low[i]:
                self.low[i] = speed
            share = speed * self.per_speed[i]
            if -1.0 <= share <= 1.0:
                self.over[i] = 0
            else:
                self.over[i] += 1
                if self.over[i] > self.longest[i]:
                    self.longest[i] = self.over[i]
            share = self.torques[self.servos[i]] * self.per_torque[i]
            if not -1.0 < share < 1.0:
                any_held = True
                self.held[i] += 1
        if any_held:
            self.any_held += 1
