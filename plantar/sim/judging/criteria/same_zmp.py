"""The skin finds the ZMP that force-torque sensors at the ankles find."""

import math

from plantar.common.settings.schema import share
from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured
from plantar.sim.judging.unmet import unmet


class SameZmp(Criterion):
    """The ZMP by the skin agrees with the one by the ankles (T 4.3.1).

    Attributes:
        rms: Largest root mean square of their distance.
    """

    rms: float = share(0.01, "sole", 0, 1)

    def claim(self) -> str:
        return f"the ZMP by the skin is that by the ankles to {1e3 * self.rms:.2g} mm RMS"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        if run.zmps is None:
            return not_measured("same_zmp", "the ankles had no force-torque sensors")
        found = run.zmps.summary()["rms_m"]
        rms = math.inf if found is None else float(found)
        limit = round(self.rms, 6)
        text = f"the ZMPs by skin and ankles differed by {1e3 * rms:.2f} mm RMS; allowed: {1e3 * limit:.2g} mm"
        return unmet((rms <= limit, "same_zmp", rms, limit, text))
