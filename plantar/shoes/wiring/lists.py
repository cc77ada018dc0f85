"""Nets and leads of shoes as CSV."""

from collections.abc import Mapping

from plantar.common.table_writer import csv_text
from plantar.shoes.wiring.nets import Wiring


def nets_text(wirings: Mapping[str, Wiring]) -> str:
    """Gives every pin of every net, by side, as CSV."""
    rows = [
        [side, net, pin.part, pin.name]
        for side, wiring in wirings.items()
        for net, pins in wiring.nets.items()
        for pin in pins
    ]
    return csv_text(("side", "net", "part", "pin"), rows)


def harness_text(wirings: Mapping[str, Wiring]) -> str:
    """Gives every soldered lead, by side, as CSV; of a sheet the lines of its tail."""
    rows: list[list[object]] = []
    for side, wiring in wirings.items():
        rows += [
            [side, lead.cell, lead.net, str(lead.start), str(lead.end), lead.colour, lead.length]
            for lead in wiring.leads
        ]
        rows += [[side, "", net, "FB1", f"J1.{n}", "", ""] for n, net in enumerate(wiring.tail, start=1)]
    return csv_text(("side", "cell", "net", "from", "to", "colour", "length_mm"), rows)
