"""A scene's tables `[partner]` and `[guide]`."""

from plantar.common.settings.schema import Settings, choice, number, share


class PartnerSettings(Settings):
    """A mobile robot that is pushed or pushes (K, appendix B).

    K's Table 2 is for H1; numbers scale with weight, mass and leg.

    Attributes:
        kind: Whether there is one.
        role: Only a "leader" has a built-in force.
        virtual_mass: M of K 39.
        virtual_damping: D of K 39.
        virtual_stiffness: K of K 39.
        stride: S of K 41: distance from the rest at which it moves.
        built_in_force: A leader's f_in of K 39.
        starts: Time in s from which it leads or follows.
        apart: Hand's initial distance in m from the skin.
        body_mass: TIAGo's 70 kg for H1.
        drive_force: Its drive's largest.
        hand_noise: Of its hand's force-torque sensor in N.
    """

    kind: str = choice("none", "mobile_robot")
    role: str = choice("follower", "leader")
    virtual_mass: float = share(0.581, "mass", 0.01, 1e4)
    virtual_damping: float = share(0.1725, "weight beat/leg", 0.0, 1e5)
    virtual_stiffness: float = share(0.1422, "weight/leg", 0.0, 1e6)
    stride: float = share(1 / 6, "leg", 0.001, 10)
    built_in_force: float = share(0.01778, "weight", 0.0, 1e4)
    starts: float = number(2.0, "s", 0.0, 600)
    apart: float = share(0.05, "leg", 0.0, 1)
    body_mass: float = share(0.814, "mass", 0.01, 1e4)
    drive_force: float = share(0.3, "weight", 0.1, 1e5)
    hand_noise: float = share(0.0006, "weight", 0.0, 100)


class GuideSettings(Settings):
    """A hand that leads the robot by its moving arm (`[arm]`).

    Attributes:
        way: In m; 0 for no guide.
        toward: Direction in the robot's initial frame; "seeded": drawn.
        sets_out: Time in s until which it goes along with the arm.
        within: Seconds that the seed adds at most, by default a stride.
        hand_speed: Mean speed in m/s.
        hand_spring: Stiffness in N/m along its way.
        hand_force: Largest leading force in N.
    """

    way: float = number(0.0, "m", 0.0, 10.0)
    toward: str = choice("seeded", "forward", "backward")
    sets_out: float = number(2.0, "s", 0.0, 600)
    within: float = share(9.7, "beat", 0.0, 60.0)
    hand_speed: float = share(0.0165, "leg/beat", 1e-3, 2.0)
    hand_spring: float = share(0.3, "weight/leg", 1.0, 1e6)
    hand_force: float = share(0.05, "weight", 0.01, 1e4)
