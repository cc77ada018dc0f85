"""Fields of a reading, kept without running Python where time and arrays are plain."""

try:
    import cython
except ImportError:
    from plantar.kernels.base import without_cython as cython

from ..base import vectors

__all__ = ["ReadingFields"]

_LARGEST = 1e300
"""`plantar.arguments.LARGEST`: what is beyond it is looked at by `checked`."""


class ReadingFields:
    """The fields of `plantar.Reading`, whose method `_checked` converts those that are not plain."""

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

    def _fill(self, time, force, proximity, temperature, acceleration):
        if cython.compiled:
            self.time, self.force, self.proximity = time, force, proximity
            self.temperature, self.acceleration = temperature, acceleration
        else:  # past what keeps others from assigning
            self.__dict__.update(time=time, force=force, proximity=proximity)
            self.__dict__.update(temperature=temperature, acceleration=acceleration)
