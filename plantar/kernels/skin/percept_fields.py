"""What a percept is made of, and the two results that most of its members read: sums of loads, and the hull.

Plain Python that also compiles ahead of time (`percept_fields.pxd` gives the C types). `plantar.percepts.percept` has
the public class, which checks what comes otherwise.
"""

from __future__ import annotations

from ..base import memory

__all__ = ["PerceptFields"]


class PerceptFields:
    """The fields of `plantar.Percept`.

    That has `PLAIN`, the classes of layout and reading and the options that need no check, and a method `_checked`,
    which gives threshold, masks and options where something else came.

    Args:
        layout: The sole, n taxels.
        reading: What its taxels measured.
        force_threshold: Activation threshold in N; the layout's own where None.
        active: Mask (n,) of taxels to take as active; those above the threshold where None.
        stuck: Mask (n,) of stuck taxels; none where None.
        options: What else may be told; the usual where None.
    """

    def __init__(self, layout, reading, force_threshold=None, *, active=None, stuck=None, options=None):
        of_layout, of_reading, usual = self.PLAIN
        plain = type(layout) is of_layout and type(reading) is of_reading and active is None and stuck is None
        if force_threshold is not None or not (options is None or options is usual):
            plain = False
        kernel = layout.kernel if plain else None
        if plain and memory.size(reading.force) == kernel.taxels:
            self._kernel = kernel
            self._fill(layout, reading, kernel.threshold, None, None, usual, False)
        else:
            self._keep(layout, reading, *self._checked(layout, reading, force_threshold, active, stuck, options))

    def _keep(self, layout, reading, force_threshold, active, stuck, options):
        """Keep fields that are right."""
        self._kernel = layout.kernel
        self._fill(layout, reading, force_threshold, active, stuck, options, options.fill)

    def _fill(self, layout, reading, force_threshold, active, stuck, options, fills):
        """`_keep`, where it is known whether the options say `fill`: not by those that are usual."""
        self.layout, self.reading, self.force_threshold, self.options = layout, reading, force_threshold, options
        self._given_active, self._stuck = active, stuck
        self._fills = fills
        # Whether what is active is nothing but a comparison, which a kernel then makes on its way.
        self._compared = active is None and stuck is None and not self._fills
        self._summed = self._polygon = None
        self._has_area, self._area, self._x, self._y = False, 0.0, 0.0, 0.0

    def _take_loads(self, loads):
        """Keep loads that are summed already."""
        self._summed = loads

    def _loads(self):
        """Wrench, contact area and CoP (9,), summed in one pass when the first of them is asked for."""
        if self._summed is None:
            kernel, force = self._kernel, self.reading.force
            if self._compared:
                loads = kernel.loads_above(force, self.force_threshold, kernel.limit)
            else:
                loads = kernel.loads(self.sound_force if self._fills else force, self.active)
            memory.close(loads)
            self._summed = loads
        return self._summed

    def _hull_area(self):
        """Area in m^2 of the support polygon, without an array of it: its walk costs less than that, and is made again
        for those who want it."""
        if not self._has_area:
            if self._compared:
                kernel = self._kernel
                self._take(kernel.measured_hull_above(self.reading.force, self.force_threshold, kernel.limit))
            else:
                self._hull()
        return self._area

    def _hull(self):
        """Support polygon (k, 2) in m; its area and centroid are found with it."""
        if self._polygon is None:
            kernel = self._kernel
            if self._compared:
                found = kernel.hull_above(self.reading.force, self.force_threshold, kernel.limit)
            else:
                found = kernel.hull(self.active)
            polygon, area, x, y = found
            memory.close(polygon)
            self._polygon = polygon
            self._take((area, x, y))
        return self._polygon

    def _take(self, measured):
        """Keep area and centroid."""
        area, x, y = measured
        self._area, self._x, self._y = float(area), float(x), float(y)
        self._has_area = True

    def _hull_centroid(self):
        """Centroid of the support polygon in m, of a sole that has one."""
        self._hull()
        return self._x, self._y
