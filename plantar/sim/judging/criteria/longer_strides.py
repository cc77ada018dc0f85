"""Strides grow along the pushes on them."""

from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured


class LongerStrides(Criterion):
    """Each pushed step becomes longer along its push (`PushTruth.stride_reasons`)."""

    def claim(self) -> str:
        return "each pushed step becomes longer along its push"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        if run.touched is None:
            return not_measured("longer_strides", "no hand pushed")
        found: list[Reason] = run.touched.stride_reasons(run.judge.steps.last_stands())
        return found
