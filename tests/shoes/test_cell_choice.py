"""The cell for a robot's weight: one that carries its load, and sees the most of it."""

import re
from dataclasses import replace

import pytest

from plantar.errors import FootError, InputError
from plantar.shoes import ShoeParameters, foot_from_dimensions
from plantar.shoes.cell_choice import choose_cell
from plantar.shoes.order import ShoeOrder
from plantar.shoes.ordered import build_ordered


@pytest.mark.long
def test_the_choice_carries_the_load_and_says_why_others_do_not():
    foot = foot_from_dimensions("a", length=0.2, width=0.083, corner_radius=0.01, mass=33.0)
    choice = choose_cell(foot)
    assert choice.cell.part
    assert f"cell {choice.cell.name} is chosen for 33 kg" in choice.notes[0]
    assert any(note.startswith("cell fx29_25: load of a taxel, N is 485.6, allowed 86") for note in choice.notes)
    build = build_ordered(foot, ShoeOrder(cell="auto", layout_only=True, side="left"), ShoeParameters())
    assert build.notes[: len(choice.notes)] == choice.notes
    assert build.fit.cell == choice.cell


def test_a_foot_too_small_for_a_sheets_combs_gets_other_cells():
    """A taxel at the rim of so small a sheet has no room for a finger of its comb, from which a line could lead."""
    foot = foot_from_dimensions("tiny", length=0.062, width=0.039, corner_radius=0.005)
    choice = choose_cell(foot)
    assert choice.cell.name == "fsr_402_short"
    assert any(note.startswith("cell velostat: ") for note in choice.notes)


@pytest.mark.long
def test_a_weight_that_no_cell_carries_is_refused():
    foot = foot_from_dimensions("a", length=0.12, width=0.07, corner_radius=0.01, mass=300.0)
    with pytest.raises(FootError, match="no cell that can be bought suits this foot and 300 kg: cell fsr_402"):
        choose_cell(foot)


@pytest.mark.long
def test_the_weight_that_the_strongest_cell_carries_is_named_and_carried():
    heavy = foot_from_dimensions("a", length=0.24, width=0.11, corner_radius=0.02, mass=65.0)
    with pytest.raises(FootError, match=r"allowed: up to \d+ kg with cell velostat; or --cell hex") as refused:
        choose_cell(heavy)
    most = float(re.search(r"up to (\d+) kg", str(refused.value))[1])
    assert choose_cell(replace(heavy, mass=most)).cell.name == "velostat"


def test_an_insole_is_not_chosen_for():
    foot = foot_from_dimensions("a", length=0.26, width=0.095, corner_radius=0.03)
    with pytest.raises(InputError, match="of an insole give --cell velostat"):
        build_ordered(foot, ShoeOrder(cell="auto", insole=6.0), ShoeParameters())


@pytest.mark.parametrize(
    ("order", "message"),
    [
        (ShoeOrder(cell="auto", cell_area=300.0), "leave --cell-area out"),
        (ShoeOrder(cell="auto", rim="fine"), "a fine rim is made of skin"),
    ],
)
def test_what_a_chosen_cell_decides_is_not_asked_for_beside_it(order, message):
    foot = foot_from_dimensions("a", length=0.2, width=0.083, corner_radius=0.01, mass=33.0)
    with pytest.raises(InputError, match=message):
        build_ordered(foot, order, ShoeParameters())
