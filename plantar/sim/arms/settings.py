"""A scene's table `[arm]`: the arm that a walking robot moves."""

from plantar.common.settings.schema import Settings, choice, number, share, tables


class ArmSettings(Settings):
    """An arm under the companion's tasks (A 13-14, 18): springs to a posture, yielding skin.

    Attributes:
        side: Which moves; with "none" both belong to the chest.
        posture: Degrees from shoulder to wrist; empty: the machine file's.
        spring: Share of a joint's largest torque per rad.
        damper: Likewise, in s/rad; above 0.3 h1's wrist shakes.
        gain: Factor on measured force; 1 yields as without friction and gears, 0 holds.
        filter: Low pass of taxel forces in s.
        speed_noise: Standard deviation in rad/s; angles have the legs' noise.
    """

    side: str = choice("none", "left", "right")
    posture: tuple[float, ...] = tables("a list of angles in degrees, one a joint")
    spring: float = number(0.6, "1/rad", 0.0, 1000.0)
    damper: float = number(0.08, "s/rad", 0.0, 100.0)
    gain: float = number(1.5, "1", 0.0, 100.0)
    filter: float = share(0.162, "beat", 0.0, 10.0)
    speed_noise: float = number(1e-3, "rad/s", 0.0, 1.0)
