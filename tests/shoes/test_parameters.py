"""Tests of the shoe's parameters."""

from __future__ import annotations

import json
import tomllib
from dataclasses import fields
from pathlib import Path

import pytest

from plantar.errors import InputError
from shoes.parameters import ShoeParameters, read_parameters


def test_defaults_are_in_their_ranges_and_leave_a_floor() -> None:
    p = ShoeParameters()
    for name, value in p.as_dict().items():
        low, high, unit, text = ShoeParameters.range_of(name)
        assert low <= value <= high
        assert unit in ("mm", "g/cm3")
        assert text
    assert p.floor == p.plate_thickness - p.patch_depth - p.pocket_depth
    assert p.floor >= p.wall_min


@pytest.mark.parametrize("name", [f.name for f in fields(ShoeParameters)])
@pytest.mark.parametrize("bad", [-1.0, 1e6, float("nan"), float("inf"), "3", None, True])
def test_a_value_out_of_range_is_named_with_what_is_allowed(name: str, bad: object) -> None:
    low, high, unit, _ = ShoeParameters.range_of(name)
    with pytest.raises(InputError, match=f"shoe parameter {name} is .*; allowed: {low:g} to {high:g} {unit}"):
        ShoeParameters.from_mapping({name: bad})


def test_values_that_contradict_each_other_are_refused() -> None:
    with pytest.raises(InputError, match="of floor above the pockets"):
        ShoeParameters(plate_thickness=8.0)
    with pytest.raises(InputError, match="rib is 1 mm"):
        ShoeParameters(rib=1.0)
    with pytest.raises(InputError, match="border is 20 mm"):
        ShoeParameters(border=20.0)


def test_files_replace_what_they_name(tmp_path: Path) -> None:
    values = {"plate_thickness": 14, "rim_height": 20.5}
    (tmp_path / "p.json").write_text(json.dumps(values))
    (tmp_path / "p.toml").write_text("plate_thickness = 14\nrim_height = 20.5\n")
    expected = ShoeParameters(plate_thickness=14.0, rim_height=20.5)
    assert read_parameters(tmp_path / "p.json") == expected
    assert read_parameters(tmp_path / "p.toml") == expected


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("p.json", "{", "is not valid JSON"),
        ("p.json", "[1]", "is not a table"),
        ("p.toml", "a = ", "is not valid TOML"),
        ("p.toml", "plate = 3", "unknown shoe parameter 'plate'; allowed: plate_thickness"),
        ("p.json", '{"rim_height": 900}', "allowed: 2 to 60 mm"),
        ("p.json", '{"rim_height": {"mm": 3}}', "allowed: 2 to 60 mm"),
        ("p.yaml", "a: 3", "allowed: .json, .toml"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path: Path, name: str, text: str, message: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_parameters(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert name in str(caught.value)


def test_a_missing_or_binary_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_parameters(tmp_path / "none.toml")
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not a text file"):
        read_parameters(tmp_path / "b.toml")


def test_the_guide_names_every_parameter_with_its_default(repository: Path) -> None:
    guide = (repository / "docs" / "shoes.md").read_text(encoding="utf-8")
    for name, value in ShoeParameters().as_dict().items():
        low, high, unit, _ = ShoeParameters.range_of(name)
        assert f"| `{name}` | {value:g} | {low:g} to {high:g} | {unit} |" in guide


def test_toml_written_from_the_defaults_reads_back() -> None:
    text = "\n".join(f"{k} = {v}" for k, v in ShoeParameters().as_dict().items())
    assert ShoeParameters.from_mapping(tomllib.loads(text)) == ShoeParameters()
