"""Settings of a robot's partner: a scene's tables `[partner]` and `[guide]`."""

from __future__ import annotations

from plantar.settings.schema import Settings, choice, number, share

__all__ = ["GuideSettings", "PartnerSettings"]


class PartnerSettings(Settings):
    """A mobile robot before the robot, pushed by it or pushing it (K, appendix B).

    Numbers of K's Table 2 are those of H1; they scale with weight, mass and leg.

    Attributes:
        kind: Whether there is one.
        role: A "leader" has a built-in force, a "follower" has none.
        virtual_mass: M of K 39.
        virtual_damping: D of K 39.
        virtual_stiffness: K of K 39.
        stride: S of K 41: distance from its rest at which the rest moves.
        built_in_force: f_in of K 39, of a leader alone.
        starts: Time in s from which a leader's force acts, and a follower is moved.
        apart: Distance in m of its hand from the robot's skin at the start.
        body_mass: TIAGo's of 70 kg next to H1.
        drive_force: Largest force of its drive.
        hand_noise: Standard deviation in N of the force-torque sensor in its hand.
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
    """A hand that takes the forearm of the arm that moves (`[arm]`), and leads the robot.

    Attributes:
        way: How far it goes in m; 0 for no guide.
        toward: Direction in the robot's frame at the start; with "seeded" the seed chooses.
        sets_out: Time in s from which it leads; until then it goes along with the arm.
        within: The seed adds up to this many s: by default any phase of a stride.
        hand_speed: Mean speed in m/s.
        hand_spring: Stiffness in N/m of the spring by which it follows its way.
        hand_force: Largest force in N with which it leads.
    """

    way: float = number(0.0, "m", 0.0, 10.0)
    toward: str = choice("seeded", "forward", "backward")
    sets_out: float = number(2.0, "s", 0.0, 600)
    within: float = share(9.7, "beat", 0.0, 60.0)
    hand_speed: float = share(0.0165, "leg/beat", 1e-3, 2.0)
    hand_spring: float = share(0.3, "weight/leg", 1.0, 1e6)
    hand_force: float = share(0.05, "weight", 0.01, 1e4)
