"""The net model: every pin once, every cell read, and leads, channels, list and bill that say the same."""

import csv
import io
import re

import pytest

from plantar.errors import FootError
from plantar.shoes import build_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import Cell, read_cell
from plantar.shoes.checks.printability import Weights
from plantar.shoes.papers.bill import bill_of_parts, bill_text
from plantar.shoes.wiring.lists import harness_text, nets_text
from plantar.shoes.wiring.nets import Pin, lead_colours, wiring_of

CELLS = ["velostat", "fsr_402_short", "fx29_25"]


@pytest.mark.parametrize("cell", CELLS)
def test_every_pin_is_on_one_net_and_every_cell_is_read(cell, wired_builds):
    build = wired_builds[cell]
    for shoe in build.shoes:
        wiring = wiring_of(shoe, build.parameters)
        pins = [pin for joined in wiring.nets.values() for pin in joined]
        assert len(pins) == len(set(pins))
        assert all(len(joined) > 1 for joined in wiring.nets.values())
        ids = shoe.layout.ids.tolist()
        cells = {pin.part for pin in pins if pin.part[0] == "T"}
        assert cells == {f"T{k}" for k in ids}
        for k, channel in zip(ids, wiring.channels, strict=True):
            if wiring.circuit == "matrix":
                row, column = channel.split()
                assert (wiring.net_of(Pin(f"T{k}", "1")), wiring.net_of(Pin(f"T{k}", "2"))) == (row, column)
            elif wiring.circuit == "divider":  # its own resistor and channel
                net = {str(pin) for pin in wiring.nets[f"T{k}"]}
                assert net == {f"T{k}.2", channel, f"R{k}.1"}
            else:
                assert channel in {str(pin) for pin in wiring.nets[f"DT{k}"]}
        for lead in wiring.leads:  # a lead joins two pins of its net
            assert {lead.start, lead.end} <= set(wiring.nets[lead.net])
            assert lead.length > 200


def test_a_sheet_has_rows_and_columns_as_its_layout():
    foot = foot_from_dimensions("a", length=0.2, width=0.083, corner_radius=0.01, mass=33.0)
    build = build_shoe(foot, side="left", cell=read_cell("velostat"), layout_only=True)
    shoe = build.shoes[0]
    wiring = wiring_of(shoe, build.parameters)
    rows, columns = shoe.plan.sheet_lines
    lines = [net for net in wiring.nets if net[0] in "RC" and net[1:].isdigit()]
    assert len(lines) == rows + columns
    assert all(any(pin.part == "U1" for pin in wiring.nets[f"R{r}"]) for r in range(rows))
    assert all(any(pin.part == f"RC{c}" for pin in wiring.nets[f"C{c}"]) for c in range(columns))


def test_lists_hold_the_same_nets_and_leads(wired_builds):
    build = wired_builds["fx29_25"]
    wirings = {shoe.side: wiring_of(shoe, build.parameters) for shoe in build.shoes}
    rows = list(csv.DictReader(io.StringIO(nets_text(wirings))))
    for side, wiring in wirings.items():
        told = {(r["net"], f"{r['part']}.{r['pin']}") for r in rows if r["side"] == side}
        assert told == {(net, str(pin)) for net, pins in wiring.nets.items() for pin in pins}
    leads = list(csv.DictReader(io.StringIO(harness_text(wirings))))
    assert len(leads) == sum(len(w.leads) for w in wirings.values()) == 2 * 4 * 4
    assert {r["colour"] for r in leads} == {"red", "black", "green", "white"}


@pytest.mark.parametrize("cell", CELLS)
def test_every_line_of_what_is_bought_can_be_ordered(cell, wired_builds):
    build = wired_builds[cell]
    wiring = wiring_of(build.shoes[0], build.parameters)
    for line in wiring.bought:
        assert line.maker
        assert line.part
        assert line.quantity > 0
        assert line.address.startswith("https://")
    parts = {pin.part for pins in wiring.nets.values() for pin in pins if pin.part[0] in "UJ"}
    ordered = sum(line.quantity for line in wiring.bought if line.references[:1] in ("U", "J"))
    assert ordered == len(parts)


@pytest.mark.parametrize("cell", CELLS)
def test_every_line_of_a_bill_states_what_to_order_and_where(cell, wired_builds):
    build = wired_builds[cell]
    for shoe in build.shoes:
        wiring = wiring_of(shoe, build.parameters)
        lines = bill_of_parts(shoe, build, Weights(0.0, 0.0, 0.0, 0.0), wiring)
        assert len(lines) > len(wiring.bought)
        for line in lines:
            assert line.order, line
            assert re.match(r"https://[\w.-]+\.\w+/", line.address), line
            assert line.quantity > 0
        assert "'-" not in bill_text({shoe.side: lines})  # a dash alone is marked, as spreadsheets calculate with it


def test_cells_of_a_laboratory_have_no_wiring_and_too_many_are_refused(small_foot):
    build = build_shoe(small_foot, side="left", layout_only=True)
    assert wiring_of(build.shoes[0], build.parameters) is None
    foot = foot_from_dimensions("h", length=0.224, width=0.147, corner_radius=0.02, mass=47.0)
    with pytest.raises(FootError, match=r"cell fsr_402_short: \d+ of them; one board reads 48"):
        build_shoe(foot, side="left", cell=read_cell("fsr_402_short"), layout_only=True)


def test_colours_that_name_no_pins_are_refused():
    with pytest.raises(FootError, match=r"lead_colours is 'red, black'; allowed: a colour each of E\+"):
        lead_colours(Cell(shape="round", size=20.0, thickness=5.0, lead_colours="red, black"))
