"""Fields of a percept, and what most members read: active taxels, loads, hull."""

try:
    import cython
except ImportError:
    from plantar.kernels.base import without_cython as cython

from ..base import memory, vectors

__all__ = ["PerceptFields", "ReadingFields", "unsaturated"]


_INFINITE = float("inf")


class PerceptFields:
    """Fields of `plantar.Percept`, which has `PLAIN`, classes without a check, and `_checked`."""

    def __init__(self, layout, reading, force_threshold=None, *, active=None, stuck=None, options=None):
        of_layout, of_reading, usual = self.PLAIN
        plain = type(layout) is of_layout and type(reading) is of_reading and active is None and stuck is None
        if force_threshold is not None or not (options is None or options is usual):
            plain = False
        kernel = layout.kernel if plain else None
        if plain and memory.size(reading.force) == kernel.taxels:
            self._fill(kernel, layout, reading, kernel.threshold, None, None, usual, True)
        else:
            self._keep(layout, reading, *self._checked(layout, reading, force_threshold, active, stuck, options))

    def _keep(self, layout, reading, force_threshold, active, stuck, options):
        compared = active is None and stuck is None and not options.fill
        self._fill(layout.kernel, layout, reading, force_threshold, active, stuck, options, compared)

    def _fill(self, kernel, layout, reading, force_threshold, active, stuck, options, compared):
        """`_keep`, where it is known whether a kernel's comparison decides what is active."""
        self._kernel = kernel
        self._compared = compared
        self.layout = layout
        self.reading = reading
        self.force_threshold = force_threshold
        self.options = options
        self._given_active = active
        self._stuck = stuck
        self._summed = None
        self._found = None

    def _fill_summed(self, layout, reading, usual, loads):
        """`_keep` with the layout's threshold and known loads, which are closed to writing, and what follows from
        them.
        """
        kernel = layout.kernel
        memory.close(loads)
        self._fill(kernel, layout, reading, kernel.threshold, None, None, usual, True)
        self._summed = loads
        vertical = memory.values(loads)[2]
        known = self.__dict__  # where lazy members look first
        known["vertical_force"] = float(vertical)
        known["wrench_in_sole"] = loads[:6]
        known["position_cop_in_sole"] = loads[7:] if 0.0 < vertical < _INFINITE else None

    def _active_above(self):
        """Mask (n,) of taxels above the threshold; None if more decides."""
        if self._compared:
            return self._kernel.active(self.reading.force, self.force_threshold, self._kernel.limit)
        return None

    def _loads(self):
        """Wrench, contact area and CoP (9,), in one pass."""
        if self._summed is None:
            kernel = self._kernel
            force = self.reading.force
            if self._compared:
                loads = kernel.loads_above(force, self.force_threshold, kernel.limit)
            else:
                loads = kernel.loads(self.sound_force if self.options.fill else force, self.active)
            memory.close(loads)
            self._summed = loads
        return self._summed

    def _wrench(self):
        """Ground reaction wrench (6,) in N and N m."""
        return self._loads()[:6]

    def _cop(self):
        """Center of pressure (2,) in m; None without load."""
        loads = self._loads()
        vertical = memory.values(loads)[2]
        return loads[7:] if 0.0 < vertical < _INFINITE else None

    def _centroid(self):
        """Centroid (2,) of support polygon in m; None without contact."""
        polygon, _area, x, y = self._hull()
        return vectors.vector2(x, y) if len(polygon) else None

    def _hull(self):
        """Support polygon (k, 2) in m, its area, its centroid's x and y."""
        if self._found is None:
            kernel = self._kernel
            if self._compared:
                found = kernel.hull_above(self.reading.force, self.force_threshold, kernel.limit)
            else:
                found = kernel.hull(self.active)
            memory.close(found[0])
            self._found = found
        return self._found


def unsaturated(kind, layout, reading):
    """Percept, of the class `kind`, of a sole's plain reading with its loads summed; None if a taxel is saturated."""
    kernel = layout.kernel
    loads = kernel.unsaturated_loads(reading.force, layout.force_threshold, layout.force_limit)
    if loads is None:
        return None
    percept = kind.__new__(kind)
    percept._fill_summed(layout, reading, kind.PLAIN[2], loads)
    return percept


_LARGEST = 1e300
"""`plantar.common.arguments.LARGEST`: what is beyond it is looked at by `checked`. Nature: floating point."""


class ReadingFields:
    """Fields of `plantar.Reading`, whose `_checked` converts those not plain."""

    def __init__(self, time, force, proximity=None, temperature=None, acceleration=None):
        copy = vectors.kept(force)
        near = None if proximity is None else vectors.kept(proximity)
        plain = type(time) is float and -_LARGEST <= time <= _LARGEST and copy is not None
        if proximity is not None and (near is None or copy is None or len(near) != len(copy)):
            plain = False
        if plain and temperature is None and acceleration is None:
            self._fill(time, copy, near, None, None)
        else:
            self._keep(*self._checked(time, force, proximity, temperature, acceleration))

    def _keep(self, time, force, proximity, temperature, acceleration):
        self._fill(time, force, proximity, temperature, acceleration)

    def _take_over(self, time, force, proximity):
        """Fields of a reading of arrays that were made for it; closed to writing."""
        memory.close(force)
        if proximity is not None:
            memory.close(proximity)
        self._fill(time, force, proximity, None, None)

    def _fill(self, time, force, proximity, temperature, acceleration):
        if cython.compiled:
            self.time = time
            self.force = force
            self.proximity = proximity
            self.temperature = temperature
            self.acceleration = acceleration
        else:  # past what keeps others from assigning
            self.__dict__.update(time=time, force=force, proximity=proximity)
            self.__dict__.update(temperature=temperature, acceleration=acceleration)
