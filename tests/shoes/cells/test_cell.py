"""Tests of a cell's TOML: built-in ones, and one clear line for what is not allowed."""

import math

import pytest

from plantar.errors import InputError
from plantar.shoes.cells.cell import KEYS, SHAPES, Cell, built_in_cells, read_cell


@pytest.mark.parametrize("name", sorted(built_in_cells()))
def test_built_in_cells_read_back_from_what_they_tell(name):
    cell = read_cell(name)
    assert cell.name == name
    assert cell.about
    assert Cell.from_mapping(cell.as_dict(), "again") == cell


def test_the_film_is_that_of_its_data_sheet():
    fsr = read_cell("fsr_402_short")
    assert (fsr.kind, fsr.rated_load, fsr.size + fsr.tail_length) == ("film", 20.0, 25.0)
    assert fsr.active_area == pytest.approx(math.pi * 6.35**2)


def test_cells_that_can_be_bought_state_what_to_order_and_how_they_respond():
    bought = {name: cell for name in built_in_cells() if (cell := read_cell(name)).maker}
    assert set(built_in_cells()) - set(bought) == {"hex"}  # the papers' laboratory's
    for cell in bought.values():
        assert cell.part
        assert cell.data_sheet.startswith("https://")
        assert cell.source
        assert cell.circuit != "own"
        assert min(cell.gain_scatter, cell.hysteresis, cell.drift) > 0.0


def test_every_key_belongs_to_a_shape_and_is_described():
    rows = {row["name"]: row for row in Cell.table()}
    assert set(rows) == {key for keys in KEYS.values() for key in keys}
    assert all(row["text"] and set(row["shapes"]) <= set(SHAPES) for row in rows.values())


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("size = 20", "shape is missing; allowed: hex, square, rectangle, round, sheet"),
        ('shape = "star"', "shape is 'star'; allowed: hex"),
        ('shape = "square"', "of shape square has no size"),
        ('shape = "square"\nsize = 2', "size is 2 mm; allowed: 4 to 120 mm"),
        ('shape = "square"\nsize = "20 mm"', "size is '20 mm' mm; allowed: 4 to 120 mm"),
        ('shape = "square"\nsize = true', "size is True mm; allowed: 4 to 120 mm"),
        ('shape = "square"\nsize = nan', "size is nan mm; allowed: 4 to 120 mm"),
        ('shape = "square"\nsize = 20\nactive = 0', "active is 0 mm; allowed: 2 to 120 mm"),
        ('shape = "square"\nsize = 20\nsise = 3', "unknown key 'sise'; nearest: size"),
        ('shape = "square"\nsize = 20\nline_width = 3', "unknown key 'line_width'"),
        ('shape = "square"\nsize = 20\nactive = 30\nthickness = 1', "active is 30 mm; allowed: size = 20 mm or less"),
        ('shape = "square"\nsize = 20\nactive = 10', "active area has no thickness"),
        ('shape = "square"\nsize = 20\nstiffness = 50', "stiffness is that of a body with a thickness"),
        ('shape = "square"\nsize = 20\ntail_length = 5', "one of tail_length and tail_width"),
        ('shape = "square"\nsize = 20\nconnector_length = 5', "one of connector_length and connector_height"),
        ('shape = "round"\nsize = 20\nthickness = 1\nconnector_length = 5\nconnector_height = 2',
         "connector_length is 5 mm; allowed: tail_length = 0 mm or less"),
        ('shape = "square"\nsize = 20\ntail_length = 5\ntail_width = 5', "has a tail and no active area"),
        ('shape = "round"\nsize = 20\nthickness = 1\nleads = 1.5', "leads is 1.5; allowed: a whole number"),
        ('shape = "rectangle"\nlength = 20', "has no width"),
        ('shape = "rectangle"\nlength = 20\nwidth = 9\nactive_length = 5', "one of active_length and active_width"),
        ('shape = "sheet"\npitch_x = 5\npitch_y = 5\nline_width = 6\nthickness = 1', "line_width is 6 mm; allowed"),
        ('shape = "square"\nsize = 20\nrated_load = 1', "threshold is 1.471 N; allowed: rated_load = 1 N or less"),
        ('shape = "square"\nsize = 20\nname = 3', "name is 3; allowed: a text of one line"),
        ('shape = "square"\nsize = 20\ncount = 2.5', "count is 2.5; allowed: a whole number"),
        ('shape = "square"\nsize = 20\ncircuit = "matrix"', "circuit is 'matrix' of a square cell; allowed: matrix"),
        ('shape = "square"\nsize = 20\nleads = 2\ncircuit = "bridge"', "leads is 2; allowed: 4 or more"),
        ("shape = ", "is not valid TOML"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_in_one_line(text, told, tmp_path):
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(InputError) as refused:
        read_cell(tmp_path / "mine.toml")
    assert told in str(refused.value)
    assert "mine.toml" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_an_unknown_name_is_answered_with_those_there_are(tmp_path):
    with pytest.raises(InputError, match=r"no cell 'fsr'; allowed: fsr_402, fsr_402_short, fsr_406, fx29_100, "):
        read_cell("fsr")
    with pytest.raises(InputError, match="cannot be read"):
        read_cell(tmp_path / "none.toml")


def test_a_cell_in_code_is_checked_too():
    with pytest.raises(InputError, match="line_width is not of a round cell"):
        Cell(shape="round", size=20.0, line_width=2.0)
    with pytest.raises(InputError, match="shape is 'oval'"):
        Cell(shape="oval")
