"""Arm and feet of a led robot follow the hand."""

from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured


class FollowsGuide(Criterion):
    """The arm gives way to a hand that leads, and the feet follow it (`GuideTruth.reasons`)."""

    def claim(self) -> str:
        return "the arm gives way to the hand that leads, and the feet follow it and do not go aside"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        if run.touched is None:
            return not_measured("follows_guide", "no hand led")
        found: list[Reason] = run.touched.guide_reasons()
        return found
