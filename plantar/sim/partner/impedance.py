"""The partner's impedance controller: how a mobile robot yields to pushes, and leads (K 39-41)."""

from __future__ import annotations

from plantar.sim.partner.settings import PartnerSettings

__all__ = ["Impedance"]


class Impedance:
    """Reference motion of a mobile robot along one axis.

    M x'' + D x' + K x = f_ex + f_in + K x_r (K 39). The rest x_r moves by the stride S as soon as x is farther than
    that from it, either way (K 41, whose second case has to read x < x_r - S).

    Args:
        settings: M, D, K, S and f_in; the force is a leader's alone.

    Attributes:
        position: x in m.
        velocity: x' in m/s.
        rest: x_r in m.

    Example:
        >>> law = Impedance(PartnerSettings(role="leader"))
        >>> for _ in range(20000):
        ...     law.update(0.0, 0.001)
        >>> law.rest > 0.0
        True
    """

    def __init__(self, settings: PartnerSettings) -> None:
        self._law = settings
        self._built_in = settings.built_in_force if settings.role == "leader" else 0.0
        self.position = self.velocity = self.rest = 0.0

    def update(self, force: float, period: float) -> None:
        """Advance by a `period` in s under an external `force` f_ex in N, by semi-implicit Euler (K 40)."""
        law = self._law
        pull = law.virtual_stiffness * (self.position - self.rest)
        acceleration = (force + self._built_in - law.virtual_damping * self.velocity - pull) / law.virtual_mass
        self.velocity += acceleration * period
        self.position += self.velocity * period
        if self.position > self.rest + law.stride:
            self.rest += law.stride
        elif self.position < self.rest - law.stride:
            self.rest -= law.stride
