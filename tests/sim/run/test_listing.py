"""Lists of what is built in."""

from plantar.sim.run.listing import listed, scenes_by_group


def test_each_scene_is_in_one_of_six_groups():
    groups = scenes_by_group()
    assert len(groups) == 6
    names = [name for own in groups.values() for name in own]
    assert len(names) == len(set(names))
    assert set(names) == set(listed("scenes"))
    assert all(own for own in groups.values())
    assert "beam" in groups["narrow and partial footholds"]
