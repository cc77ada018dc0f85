"""What one scene costs: the figures of `plantar bench skip`."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["SkipRow"]


@dataclass(frozen=True)
class SkipRow:
    """What one scene costs with one robot. Times are CPU times, medians of rounds in which all take turns.

    Attributes:
        scene: Name of the scene.
        robot: Name of the robot.
        settings: What was changed of the scene.
        seed: Seed of the run.
        sim_s: Simulated time in s.
        run_s: Time of the run in s, with what the scene needs.
        everything_s: Time in s of a run that computes all percepts, casts all rays and records itself.
        physics_s: Time in s of the physics alone: the same motion by `mj_step` in a loop.
        factor: Everything but the physics over the physics, in the run.
        saved: Everything but the physics with all computed, over that of the run.
        same_motion: Whether both runs and the physics alone had the same motion, to the last bit.
        motion: Hash of it.
        shares: Share of each room in the time of the run.
        skipped: How many of what were left out in the run.
        computed: How many of the same were computed.
    """

    scene: str
    robot: str
    settings: str
    seed: int
    sim_s: float
    run_s: float
    everything_s: float
    physics_s: float
    factor: float
    saved: float
    same_motion: bool
    motion: str
    shares: dict[str, float]
    skipped: dict[str, int]
    computed: dict[str, int]
