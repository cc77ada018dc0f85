"""Smooth transitions from 0 to 1."""


def minimum_jerk(phase: float) -> tuple[float, float]:
    """Minimum-jerk blend 10 s^3 - 15 s^4 + 6 s^5 and its rate at phase s, held at 0 and 1 outside."""
    if phase <= 0.0:
        return 0.0, 0.0
    if phase >= 1.0:
        return 1.0, 0.0
    s2 = phase * phase
    # nature: the minimum jerk polynomial 10 s^3 - 15 s^4 + 6 s^5 and its derivative 30 s^2 (1 - s)^2
    return s2 * phase * (10.0 + phase * (6.0 * phase - 15.0)), 30.0 * s2 * (1.0 - phase) ** 2
