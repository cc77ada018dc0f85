import numpy as np
import pytest

from gait.footsteps import straight_plan
from gait.phases import Timing, WalkSchedule
from plantar.errors import SceneError
from sim.pushing import Pusher
from sim.scene import Push
from sim.world import World

SCHEDULE = WalkSchedule(straight_plan(6)[1], Timing(), begin=1.0)


def test_the_push_has_its_impulse_time_and_direction(world: World) -> None:
    pusher = Pusher(Push(impulse=20.0, duration=0.1, direction="left", step=2), SCHEDULE, seed=0)
    swing = next(p for p in SCHEDULE.phases if p.swing and p.step == 2)
    assert pusher.shoves[0].start == pytest.approx(0.5 * (swing.start + swing.end))
    impulse = np.zeros(3)
    for k in range(8000):
        world.data.time = 0.001 * k
        pusher.apply(world)
        impulse += 0.001 * world.data.xfrc_applied[world.torso, :3]
    assert impulse == pytest.approx([0.0, 20.0, 0.0], rel=0.02)


def test_seeds_choose_all_directions_and_repeat() -> None:
    push = Push(impulse=20.0)
    chosen = [Pusher(push, SCHEDULE, seed) for seed in range(20)]
    assert [p.direction for p in chosen[:4]] == ["forward", "backward", "left", "right"]
    assert len({p.step for p in chosen}) >= 4
    again = [Pusher(push, SCHEDULE, seed) for seed in range(20)]
    assert [(p.direction, p.step) for p in chosen] == [(p.direction, p.step) for p in again]


def test_no_impulse_pushes_nobody(world: World) -> None:
    pusher = Pusher(Push(), SCHEDULE, 0)
    world.data.time = 3.0
    pusher.apply(world)
    assert pusher.step is None
    assert not world.data.xfrc_applied.any()


def test_a_step_that_is_not_walked_is_an_error() -> None:
    with pytest.raises(SceneError, match="6 steps"):
        Pusher(Push(impulse=1.0, step=6), SCHEDULE, 0)
