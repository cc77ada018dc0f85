"""Grounds lie where the planned footprints say, and are what the scene asks for."""

import math

import mujoco
import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.sim.run.scene import load_scene
from plantar.sim.terrain import (
    GROUND_GROUP,
    Beam,
    Block,
    Course,
    Flat,
    Footprint,
    Partial,
    Pebbles,
    PlannedFeet,
    Stones,
    Terrain,
    Uneven,
)

HALF = (0.125, 0.075)


SEEN = np.array([i == GROUND_GROUP for i in range(6)], dtype=np.uint8)
"""Groups of geoms that a ray meets: what soles touch is not seen."""


def feet(steps: int = 6, length: float = 0.2, sideways: float = 0.0) -> PlannedFeet:
    def footprint(side: str, x: float, y: float, k: int | None = None) -> Footprint:
        center = np.array([x + 0.02, y])
        times = () if k is None else (2.0 + 1.2 * k, 2.9 + 1.2 * k)
        return Footprint(side, center, 0.0, HALF, np.array([x, y]), *times)

    standing = {"left": footprint("left", 0.0, 0.09), "right": footprint("right", 0.0, -0.09)}
    taken = []
    for k in range(steps):
        side = "left" if k % 2 == 0 else "right"
        y = (0.09 if side == "left" else -0.09) + sideways * (k // 2 + 1)
        taken.append(footprint(side, length * (k + 1), y, k))
    return PlannedFeet(standing, tuple(taken))


def height_of(terrain: Terrain, planned: PlannedFeet, seed: int = 0):
    """Height of the ground at a point, by a ray from above through the compiled model."""
    spec = mujoco.MjSpec()
    spec.add_material(name="ground")
    terrain.ground(planned, np.random.default_rng(seed)).add_to(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)

    def height(point: np.ndarray) -> float:
        geom = np.empty(1, dtype=np.int32)
        start = np.array([point[0], point[1], 1.0])
        return 1.0 - float(mujoco.mj_ray(model, data, start, np.array([0.0, 0.0, -1.0]), SEEN, 1, -1, geom))

    return height


def share(height, foot: Footprint, level: float = 0.0, tolerance: float = 1e-3) -> float:
    """Share of a footprint that has ground at a level."""
    grid = [(a, b) for a in np.linspace(-0.99, 0.99, 31) for b in np.linspace(-0.99, 0.99, 21)]
    on = [abs(height(foot.place(a * HALF[0], b * HALF[1])) - level) < tolerance for a, b in grid]
    return float(np.mean(on))


@pytest.mark.parametrize("part", ["rear", "front", "inner", "outer"])
@pytest.mark.parametrize("wanted", [0.5, 0.3])
def test_a_partial_foothold_carries_its_share_and_the_others_all(part, wanted):
    planned = feet()
    height = height_of(Partial(step=2, share=wanted, part=part), planned)
    for k, foot in enumerate(planned.steps):
        assert share(height, foot) == pytest.approx(wanted if k == 2 else 1.0, abs=0.04)
    foot = planned.steps[2]
    spot = {"rear": (-0.1, 0.0), "front": (0.1, 0.0), "inner": (0.0, -0.06), "outer": (0.0, 0.06)}[part]
    assert height(foot.place(*spot)) == pytest.approx(0.0, abs=1e-9)


def test_a_beam_lies_between_platforms_at_its_offset_and_angle():
    planned = feet(40, length=0.0, sideways=0.08)
    height = height_of(Beam(width=0.12, length=1.3, start=0.3, offset=-0.05, yaw=5.0), planned)
    middle = planned.middle()
    for y in (0.5, 1.0):
        lateral = -0.05 + (y - 0.3) * math.tan(math.radians(5.0))  # to the left of a walk along +y is -x
        edges = [x for x in np.arange(-0.3, 0.3, 0.001) if abs(height(middle + np.array([x, y]))) < 1e-3]
        assert min(edges) == pytest.approx(-lateral - 0.06, abs=0.002)
        assert max(edges) == pytest.approx(-lateral + 0.06, abs=0.002)
    for y in (0.0, 0.29, 1.61, 2.0):
        assert height(middle + np.array([0.2, y])) == pytest.approx(0.0, abs=1e-3)
    assert height(middle + np.array([0.3, 1.0])) == pytest.approx(-0.3, abs=1e-3)


def test_no_foot_stands_on_a_beam_from_the_start_on():
    planned = feet(40, length=0.0, sideways=0.08)
    outer = float(max(foot.place(0.0, HALF[1])[1] for foot in planned.standing.values()))
    height = height_of(Beam(width=0.12, length=1.3, start=0.1), planned)
    middle = planned.middle()
    assert height(np.array([middle[0] + 0.2, outer - 0.005])) == pytest.approx(0.0, abs=1e-3)
    assert height(np.array([middle[0] + 0.2, outer + 0.005])) < -0.1


def test_the_seed_chooses_the_beams_offset_within_its_range():
    planned = feet(40, length=0.0, sideways=0.08)
    offsets = [
        Beam(offset_range=0.08).ground(planned, np.random.default_rng(s)).facts["beam_offset_m"] for s in range(40)
    ]
    assert len(set(offsets)) == 40
    assert max(np.abs(offsets)) <= 0.08
    assert min(offsets) < -0.05 < 0.05 < max(offsets)


@pytest.mark.parametrize(("pitch", "roll"), [(10.0, 0.0), (0.0, -7.0), (4.0, 5.0)])
def test_a_wedge_has_its_slope_and_height_under_the_foot(pitch, roll):
    planned = feet()
    height = height_of(Block(step=2, top=0.04, length=0.3, width=0.18, pitch=pitch, roll=roll), planned)
    foot = planned.steps[2]
    assert height(foot.place(0.0, 0.0)) == pytest.approx(0.04, abs=1e-6)
    assert height(foot.place(0.05, 0.0)) - 0.04 == pytest.approx(-0.05 * math.tan(math.radians(pitch)), abs=5e-4)
    assert height(foot.place(0.0, 0.04)) - 0.04 == pytest.approx(0.04 * math.tan(math.radians(roll)), abs=5e-4)


def test_a_foot_that_has_drifted_inwards_stands_on_one_stone():
    plan = feet(length=0.2)
    for solid in Uneven(gap=0.05).ground(plan, np.random.default_rng(3)).solids:
        inner = abs(solid.position[1]) - solid.size[1]
        assert inner == pytest.approx(0.025, abs=1e-9)


def test_uneven_stones_differ_within_their_range_and_move_under_steps_in_place():
    forward = feet()
    height = height_of(Uneven(height_range=0.015), forward, seed=3)
    heights = [height(foot.center) for foot in forward.steps]
    assert len({round(h, 6) for h in heights}) == 6
    assert max(np.abs(heights)) <= 0.015 + 1e-9
    ground = Uneven(height_range=0.015).ground(feet(length=0.0), np.random.default_rng(3))
    assert len(ground.solids) == 2
    assert [len(solid.motions) for _, solid in ground.moving] == [3, 3]
    foot = feet(length=0.0).steps[2]
    stone = ground.solids[0]
    before, after = stone.at(foot.lift_off), stone.at(foot.touchdown)
    assert not np.allclose(before, after)


def test_random_stones_keep_their_shares_and_the_last_two_are_whole():
    planned = feet(8)
    height = height_of(Stones(share_min=0.3, share_max=0.6), planned, seed=1)
    shares = [share(height, foot) for foot in planned.steps]
    assert all(0.25 < s < 0.65 for s in shares[1:-2])  # the first step reaches back onto the stone it left
    assert shares[-2:] == pytest.approx([1.0, 1.0])


def test_bumps_rise_above_sloping_stones():
    planned = feet(8)
    level, bumpy = Pebbles(bumps=0, slope_range=0.0), Pebbles(slope_range=0.0)
    flat, rough = height_of(level, planned), height_of(bumpy, planned)
    foot = planned.steps[1]
    points = [foot.place(a, b) for a in np.linspace(-0.12, 0.12, 49) for b in np.linspace(-0.07, 0.07, 29)]
    rises = [rough(p) - flat(p) for p in points]
    assert min(rises) > -1e-6
    assert 0.005 < max(rises) < 0.0151


def test_no_slope_and_no_bump_reaches_under_a_level_footprint():
    planned = feet(8)
    height = height_of(Pebbles(), planned)
    for foot in (*planned.standing.values(), *planned.steps[-2:]):
        assert share(height, foot) == 1.0
    assert all(share(height, foot) < 0.5 for foot in planned.steps[1:-3])


@pytest.mark.parametrize(("length", "step"), [(0.35, 0.2), (0.35, 0.15), (0.35, 0.0)])
def test_a_block_keeps_clear_of_where_the_same_foot_stands_before_and_after(length, step):
    planned = feet(length=step)
    block = Block(step=2, length=length, width=0.1, top=0.03, clear=0.01)
    (solid,) = block.ground(planned, np.random.default_rng(0)).solids
    room = 2.0 * step - HALF[0] - 0.01
    assert 2.0 * solid.size[0] == pytest.approx(min(length, 2.0 * room) if room > 0.0 else length)
    (whole,) = Block(step=2, length=length, width=0.1, top=0.03).ground(planned, np.random.default_rng(0)).solids
    assert 2.0 * whole.size[0] == pytest.approx(length)


def test_a_sliding_block_comes_during_the_swing():
    planned = feet()
    ground = Block(step=2, slide=0.4).ground(planned, np.random.default_rng(0))
    ((_, solid),) = ground.moving
    foot = planned.steps[2]
    assert solid.at(foot.lift_off)[1] - solid.at(foot.touchdown)[1] == pytest.approx(0.4)
    assert solid.at(foot.touchdown - 0.1) == pytest.approx(solid.at(foot.touchdown))


def test_a_slope_of_the_seeds_rises_one_way_each():
    planned, ways = feet(), set()
    for seed in range(30):
        ground = Block(step=2, slope=5.0).ground(planned, np.random.default_rng(seed))
        up = ground.solids[0].rotation[:, 2]
        assert math.degrees(math.acos(up[2])) == pytest.approx(5.0)
        ways.add((round(float(up[0]), 2), round(float(up[1]), 2)))
    assert len(ways) == 4


def test_a_course_is_spelled_out():
    solid = {"shape": "box", "size": [0.1, 0.2, 0.05], "position": [1.0, 0.0, 0.0], "angles": [0, 0, 90]}
    height = height_of(Course(solid=(solid,)), feet())
    assert height(np.array([1.15, 0.0])) == pytest.approx(0.05, abs=1e-9)
    assert height(np.array([1.0, 0.15])) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("solid", "words"),
    [
        ({"shape": "cone", "size": [1], "position": [0, 0, 0]}, "cone"),
        ({"shape": ["box"], "size": [1, 1, 1], "position": [0, 0, 0]}, "shape is"),
        ({"shape": "box", "size": [True, 1, 1], "position": [0, 0, 0]}, "size"),
        ({"shape": "box", "size": [1, 1], "position": [0, 0, 0]}, "size"),
        ({"shape": "box", "size": [1, 1, -1], "position": [0, 0, 0]}, "above 0"),
        ({"shape": "sphere", "size": [1], "position": [0, 0, math.nan]}, "position"),
        ({"shape": "sphere", "size": [1], "position": [0, 0, 0], "color": "red"}, "color"),
    ],
)
def test_bad_solids_are_named(solid, words):
    with pytest.raises(SceneError, match=words):
        Course(solid=(solid,))


def test_a_step_that_is_not_planned_is_refused():
    for terrain in (Partial(step=9), Block(step=9)):
        with pytest.raises(SceneError, match="0 to 5"):
            terrain.ground(feet(), np.random.default_rng(0))


def test_settings_choose_the_kind_first_and_then_its_keys():
    terrain = load_scene("flat", ["share=0.4", "terrain.kind=partial", "part=outer"]).terrain
    assert isinstance(terrain, Partial)
    assert (terrain.share, terrain.part) == (0.4, "outer")
    with pytest.raises(SceneError, match="share"):
        load_scene("flat", ["share=0.4"])
    with pytest.raises(SceneError, match="kind"):
        load_scene("flat", ["terrain.kind=swamp"])
    assert isinstance(load_scene("flat").terrain, Flat)
