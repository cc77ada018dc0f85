"""The list of settings holds every name that a scene takes, and each says what it is."""

import pytest

from plantar.errors import InputError
from plantar.sim.companion.experiment import companion_tables, experiment_names
from plantar.sim.run.scene import load_scene
from plantar.sim.run.scene_kind import open_scene
from plantar.sim.run.setting_list import settings_listed, settings_of_robot


def test_every_setting_has_a_default_an_allowed_range_and_a_meaning():
    every = settings_listed()
    assert len(every) > 170
    assert [full for full, told in every.items() if not told.meaning] == []
    assert all(told.allowed and told.default for told in every.values())


def test_what_is_listed_is_taken():
    for full, told in settings_listed().items():
        table, _, name = full.rpartition(".")
        section, _, kind = table.partition(".")
        if name in ("kind", "solid"):
            continue
        if section in experiment_names():
            kinds = companion_tables(section).items()
            owner = next(t for t, k in kinds if (name, told.default) in [(d.name, d.default) for d in k.described()])
            open_scene(
                "force-tracking-1" if section == "force-tracking" else section, [f"{owner}.{name}={told.default}"]
            )
            continue
        given = [f"terrain.kind={kind}"] if section == "terrain" else []
        load_scene("flat", [*given, f"{section}.{name}={told.default}"])


def test_a_table_a_setting_or_its_last_part_is_found():
    assert set(settings_listed("terrain.beam")) == {f for f in settings_listed() if f.startswith("terrain.beam.")}
    assert list(settings_listed("dcm_gain")) == ["balance.dcm_gain"]
    with pytest.raises(InputError, match="nearest: dcm_gain"):
        settings_listed("dcm_gian")


def test_a_robot_has_its_own_numbers():
    own, h1 = (settings_of_robot("landing.press_force", robot)["landing.press_force"] for robot in ("hrp2kai", None))
    assert own.share == h1.share == "0.237 weight"
    assert float(own.default) == pytest.approx(float(h1.default) * 65.0 / 86.0, rel=1e-3)
