"""A foot's landing."""

from plantar.common.settings.part import Part
from plantar.common.settings.schema import number, share, switch


class Landing(Part, table="landing", given_by={n: f"walk.{n}" for n in ("approach_height", "approach_speed")}):
    """How a foot lands.

    Attributes:
        contact_force: Vertical touchdown force in N (the papers' 70 N).
        press_force: Up to which, in N, a touching foot is pressed down.
        depth: Aimed depth in m below the expected ground.
        speed: Downwards in m/s until ground.
        acceleration: Its acceleration in m/s^2.
        reach: Most in m that it goes down.
        relax_time: In s, of a standing robot's last foot towards its estimated height; 0 leaves it.
        ground_share: Share of a new foothold's height expected for the next, 0..1.
        levelling: Rate in 1/s at which a blind foot turns parallel to the stance foot; 0 leaves it.
        probing: Whether such a foot, once loaded, turns until its center of pressure is amid its believed foothold.
        approach_height: As `SwingTrajectory` has it, for some steps after unexpected ground; 0 is one move.
        approach_speed: Its speed in m/s.
    """

    contact_force: float = share(0.083, "weight", 0, 10000)  # nature: T 4.4.5, 70 N
    press_force: float = share(0.237, "weight", 0.1, 100000)  # chosen: 200 N on h1, a quarter of the weight
    depth: float = share(1 / 1500, "leg", 0, 0.05)  # chosen: 0.4 mm on h1
    speed: float = share(0.0124, "leg/beat", 0.0001, 1)  # chosen: 30 mm/s on h1
    acceleration: float = share(0.102, "leg/beat^2", 0.01, 100)  # chosen: 1 m/s^2
    reach: float = share(0.05, "leg", 0, 0.2)  # chosen: 30 mm on h1
    relax_time: float = number(0.0, "s", 0, 100)
    # chosen: between 0, steps from scratch, and 1, every stone taken for a slope
    ground_share: float = number(0.3, "1", 0, 1)
    levelling: float = share(10.0, "1/beat", 0, 200)  # chosen: 40 1/s on h1: 25 ms
    probing: bool = switch(True)
    approach_height: float = number(0.0, "m", 0, 0.2)
    approach_speed: float = share(0.0247, "leg/beat", 0.001, 1)  # chosen: 60 mm/s on h1, as `walk.approach_speed`
