"""Tests of the shoe's parameters."""

import json
import tomllib

import pytest

from plantar.errors import InputError
from plantar.shoes.parameters import ShoeParameters, read_parameters


def test_defaults_are_in_their_ranges_and_leave_a_floor():
    p = ShoeParameters()
    for row in ShoeParameters.table():
        value = p.as_dict()[row["name"]]
        assert value == row["default"]
        assert row["text"]
        if "choices" in row:
            assert value in row["choices"]
        else:
            assert row["low"] <= value <= row["high"]
            assert row["unit"] in ("mm", "g/cm3", "kg", "-", "mm3/s", "Shore A", "kPa")
    assert p.thickness == p.pad_thickness + p.taxel_protrusion + p.pocket_depth + p.floor == 12.0
    assert p.floor >= p.wall_min


@pytest.mark.parametrize("name", [row["name"] for row in ShoeParameters.table() if "low" in row])
@pytest.mark.parametrize("bad", [-1.0, 1e6, float("nan"), float("inf"), "3", None, True])
def test_a_value_out_of_range_is_named_with_what_is_allowed(name, bad):
    low, high, unit, _ = ShoeParameters.range_of(name)
    with pytest.raises(InputError, match=f"shoe parameter {name} is .*; allowed: {low:g} to {high:g} {unit}"):
        ShoeParameters.from_mapping({name: bad})


def test_values_that_contradict_each_other_are_refused():
    with pytest.raises(InputError, match="floor is 1 mm; allowed: wall_min"):
        ShoeParameters(floor=1.0)
    with pytest.raises(InputError, match="rib is 1 mm"):
        ShoeParameters(rib=1.0)
    with pytest.raises(InputError, match="border is 20 mm"):
        ShoeParameters(border=20.0)
    with pytest.raises(InputError, match="scribe is 1 mm"):
        ShoeParameters(scribe=1.0)
    with pytest.raises(InputError, match=r"scribe is 0\.4 mm; allowed: half of pocket_depth"):
        ShoeParameters(pocket_depth=0.6)


@pytest.mark.parametrize("name", ["material", "retention", "strengthen"])
@pytest.mark.parametrize("bad", ["steel", "", 3.0, None, True])
def test_a_choice_that_there_is_not_is_named_with_those_there_are(name, bad):
    with pytest.raises(InputError, match=f"shoe parameter {name} is .*; allowed: .*, .*"):
        ShoeParameters.from_mapping({name: bad})
    with pytest.raises(InputError, match=f"{name} is a choice"):
        ShoeParameters.range_of(name)


def test_a_density_of_its_own_takes_the_materials_place():
    assert ShoeParameters(material="PETG").printed.density == 1.27
    assert ShoeParameters(material="PETG", density=1.1).printed.density == 1.1


def test_files_replace_what_they_name(tmp_path):
    values = {"floor": 7, "rim_height": 20.5, "material": "PLA"}
    (tmp_path / "p.json").write_text(json.dumps(values))
    (tmp_path / "p.toml").write_text('floor = 7\nrim_height = 20.5\nmaterial = "PLA"\n')
    expected = ShoeParameters(floor=7.0, rim_height=20.5, material="PLA")
    assert read_parameters(tmp_path / "p.json") == expected
    assert read_parameters(tmp_path / "p.toml") == expected


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("p.json", "{", "is not valid JSON"),
        ("p.json", "[1]", "is not a table"),
        ("p.toml", "a = ", "is not valid TOML"),
        ("p.toml", "plate = 3", "unknown shoe parameter 'plate'; allowed: pad_thickness"),
        ("p.json", '{"rim_height": 900}', "allowed: 2 to 60 mm"),
        ("p.json", '{"rim_height": {"mm": 3}}', "allowed: 2 to 60 mm"),
        ("p.yaml", "a: 3", "allowed: .json, .toml"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_parameters(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert name in str(caught.value)


def test_the_guide_names_every_parameter_with_its_default(repository):
    guide = (repository / "docs" / "shoes.md").read_text(encoding="utf-8")
    for row in ShoeParameters.table():
        if "choices" in row:
            allowed = ", ".join(row["choices"])
            assert f"| `{row['name']}` | {row['default']} | {allowed} | |" in guide
        else:
            allowed = f"{row['low']:g} to {row['high']:g}"
            assert f"| `{row['name']}` | {row['default']:g} | {allowed} | {row['unit']} |" in guide


def test_toml_written_from_the_defaults_reads_back():
    text = "\n".join(f"{k} = {json.dumps(v)}" for k, v in ShoeParameters().as_dict().items())
    assert ShoeParameters.from_mapping(tomllib.loads(text)) == ShoeParameters()
