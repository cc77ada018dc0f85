"""Small pushes are held by the ankles; larger ones change a step."""

from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured


class LargerPushesStep(Criterion):
    """Hands that push gently change no step, those that push hard do (`PushTruth.steps_reasons`)."""

    def claim(self) -> str:
        return "gentle pushes change no step, hard ones change one"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        if run.touched is None:
            return not_measured("larger_pushes_step", "no hand pushed")
        found: list[Reason] = run.touched.steps_reasons(run.judge.steps.last_stands())
        return found
