"""Single taxels that report what no taxel of a sole can carry."""

import math

import numpy as np

from ..base import memory

__all__ = ["TaxelWatch"]


class TaxelWatch:
    """Finds taxels of one sole to leave out, tick by tick.

    A taxel is left out that, while both soles report more than the robot weighs, reads a multiple of each of its
    neighbours for some ticks, and without which they still report its weight; and one that reads a load while its foot
    is in the air, where few of its sole do, until a swing in which it does not. So is one that pulls, in the air or
    not.

    Args:
        starts: Where each taxel's neighbours begin in `neighbours`, and where the last one's end (n + 1,), as numbers.
        neighbours: Indices of all taxels' neighbours, one after the other, as numbers.
        most: Force in N that a taxel may report in any case while the robot stands.
        alone: Multiple of its neighbours' forces that it may report beyond.
        ticks: For which it may do so.
        air: Force in N that it may report in the air.
        air_ticks: Ticks in the air with more, of successive swings together.
        few: Largest number of taxels that report more in the air at a time; where more do, the foot touches something.

    Attributes:
        out: 1 for a taxel that is left out, else 0 (n,).
        count: How many are.
    """

    def __init__(self, starts, neighbours, most, alone, ticks, air, air_ticks, few):
        self.taxels = len(starts) - 1
        self.starts = np.array(starts, dtype=np.float64)
        self.neighbours = np.array([*neighbours, -1.0], dtype=np.float64)
        self.most = most
        self.alone = alone
        self.ticks = ticks
        self.air = air
        self.air_ticks = air_ticks
        self.few = few
        self.out = np.zeros(self.taxels)
        self.count = 0
        self.over = np.zeros(self.taxels)
        self.flown = np.zeros(self.taxels)
        self.pulled = np.zeros(self.taxels)
        self.before = np.zeros(self.taxels)
        self.was_up = False
        self.begun = False

    def update(self, force, spare, up, pulls):
        """Take a tick's forces (n,) in N.

        `spare`: force in N on both soles that the robot need not weigh, 0 where they do not report too much; `up`: the
        foot is in the air; `pulls`: a taxel that pulled a tick ago, -1 for none.

        Returns whether other taxels are left out than before.
        """
        n = self.taxels
        if memory.size(force) != n:
            return False
        f = memory.values(force)
        changed = False
        if up:
            changed = self._fly(f, n)
        elif self.was_up:
            changed = self._land(n)
        self.was_up = up
        if 0 <= pulls < n:
            changed |= self._pull(pulls)
        if spare > 0.0:
            changed |= self._compare(f, n, spare)
        elif self.begun:
            self._begin(n)
        return changed

    def _begin(self, n):
        """Forget what reads too much: the soles do not."""
        over = memory.room(self.over)
        for i in range(n):
            over[i] = 0.0
        self.begun = False

    def _compare(self, f, n, spare):
        """Leave out what reads a multiple of its neighbours for long enough."""
        out = memory.room(self.out)
        over = memory.room(self.over)
        starts = memory.room(self.starts)
        others = memory.room(self.neighbours)
        changed = False
        self.begun = True
        for i in range(n):
            value = f[i]
            if not self.most < value <= spare or out[i] != 0.0:
                over[i] = 0.0
                continue
            largest = 0.0
            for k in range(int(starts[i]), int(starts[i + 1])):
                j = int(others[k])
                if out[j] == 0.0 and f[j] > largest:
                    largest = f[j]
            over[i] = over[i] + 1.0 if value > self.alone * largest else 0.0
            if over[i] >= self.ticks:
                out[i] = 1.0
                over[i] = 0.0
                self.count += 1
                changed = True
        return changed

    def _pull(self, i):
        """Leave out a taxel that pulls again and again."""
        out = memory.room(self.out)
        pulled = memory.room(self.pulled)
        pulled[i] += 1.0
        if out[i] != 0.0 or pulled[i] < self.ticks:
            return False
        out[i] = 1.0
        self.count += 1
        return True

    def _fly(self, f, n):
        """Leave out what reads a load in the air again and again."""
        out = memory.room(self.out)
        flown = memory.room(self.flown)
        before = memory.room(self.before)
        loaded = 0
        for i in range(n):
            if math.fabs(f[i]) > self.air:
                loaded += 1
        if loaded == 0 or loaded > self.few:
            return False
        changed = False
        for i in range(n):
            if math.fabs(f[i]) > self.air:
                flown[i] += 1.0
                if out[i] == 0.0 and before[i] + flown[i] >= self.air_ticks:
                    out[i] = 1.0
                    self.count += 1
                    changed = True
        return changed

    def _land(self, n):
        """Take back what read no load in the swing that has ended, and did not pull since the one before."""
        out = memory.room(self.out)
        flown = memory.room(self.flown)
        pulled = memory.room(self.pulled)
        before = memory.room(self.before)
        changed = False
        for i in range(n):
            before[i] = before[i] + flown[i] if flown[i] != 0.0 else 0.0
            if out[i] != 0.0 and flown[i] == 0.0 and pulled[i] == 0.0:
                out[i] = 0.0
                self.count -= 1
                changed = True
            flown[i] = 0.0
            pulled[i] = 0.0
        return changed
