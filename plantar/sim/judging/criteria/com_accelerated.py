"""Pushes accelerate the CoM by their height."""

from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured


class ComAccelerated(Criterion):
    """A push gives the CoM what a force at its height has to (`PushTruth.acceleration_reasons`)."""

    def claim(self) -> str:
        return "a push gives the CoM what a force at its height has to"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        if run.touched is None:
            return not_measured("com_accelerated", "no hand pushed")
        found: list[Reason] = run.touched.acceleration_reasons()
        return found
