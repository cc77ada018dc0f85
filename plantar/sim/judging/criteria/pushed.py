"""The push that a robot survives has truly arrived."""

from plantar.common.settings.schema import number
from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured
from plantar.sim.judging.unmet import unmet


class Pushed(Criterion):
    """Pushes by force or by hands deliver their impulse.

    Attributes:
        least: Share of it that arrives.
    """

    least: float = number(0.9, "1", 0, 1)

    def claim(self) -> str:
        return f"{self.least:.0%} or more of each push's impulse arrives"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        asked = float(run.scene.push.strength)
        if asked <= 0.0:
            return not_measured("pushed", "no push was asked for")
        given = run.pusher.largest_impulse() if run.touched is None else run.touched.largest_impulse()
        text = f"the push delivered {given:.1f} N s of {asked:.1f} N s; at least {self.least:.0%} has to arrive"
        return unmet((given >= self.least * asked, "pushed", given, round(self.least * asked, 4), text))
