"""One model of a shoe's wiring, of which list, drawing, page, bill, layout and firmware are made. Lengths in mm.

The read-out is a Raspberry Pi Pico 2, U1. FSRs: each is a divider with a resistor R to ground, on a channel of a
multiplexer. Load cells: each has its amplifier. A sheet: each row on a pin of U1 and on a channel, by which its voltage
is read, each column on a resistor to ground and a channel.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from plantar.errors import FootError
from plantar.shoes.build import Shoe
from plantar.shoes.cells.cell import Cell
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.cell_room import CHANNELS, MULTIPLEXERS, refuse_too_many
from plantar.shoes.plan.wiring import lead_lengths

_ANALOG = ("GP26", "GP27", "GP28")
_SELECT = ("GP19", "GP20", "GP21", "GP22")
_CLOCK = "GP19"
_COLOURS = ("black", "brown", "orange", "yellow", "green", "blue", "violet", "grey", "white", "pink")  # none is red
_SUPPLY = "red"

_PICO = ("Raspberry Pi", "SC1631", "Raspberry Pi Pico 2", "https://www.raspberrypi.com/products/raspberry-pi-pico-2/")
_MULTIPLEXER = (
    "SparkFun",
    "BOB-09056",
    "breakout of a CD74HC4067",
    "https://www.sparkfun.com/products/9056",
)
_AMPLIFIER = (
    "Avia Semiconductor",
    "HX711 module with channel B on pins (XFW-HX711), RATE to VCC for 80 readings a second",
    "bridge amplifier",
    "https://raw.githubusercontent.com/SeeedDocument/Grove-ADC-for-Load-Cell-HX711-/master/res/HX711.pdf",
)
_RESISTOR = ("Yageo", "MFR-25FBF52-1K", "resistor 1 kOhm, 1 %", "https://www.yageo.com/en/Product/Index/rlist/mfr")
_ADAPTER = ("Adafruit", "1492", "adapter of 50 lines, 0.5 mm, to 2.54 mm", "https://www.adafruit.com/product/1492")
_CONNECTOR = (
    "Adafruit",
    "1773",
    "connector of 50 lines, 0.5 mm, soldered to the adapter J1",
    "https://www.adafruit.com/product/1773",
)
_CABLE = (
    "Adafruit",
    "592, USB A to Micro-B, 3 feet",
    "from the Pico to the computer",
    "https://www.adafruit.com/product/592",
)
_WIRE = ("Adafruit", "3165, silicone cover stranded-core wire, AWG 30", "https://www.adafruit.com/product/3165")


class Pin(NamedTuple):
    """A pin of a part: T and a taxel's id, U of the read-out, R a resistor, J the tail's adapter."""

    part: str
    name: str

    def __str__(self) -> str:
        return f"{self.part}.{self.name}"


class Lead(NamedTuple):
    """A wire that is soldered between a cell and the read-out; length in mm."""

    cell: int
    net: str
    start: Pin
    end: Pin
    colour: str
    length: int


class Bought(NamedTuple):
    """A line of what is ordered for the wiring of one shoe."""

    references: str
    quantity: int
    maker: str
    part: str
    what: str
    address: str


@dataclass(frozen=True)
class Wiring:
    """Wiring of one shoe.

    Attributes:
        circuit: The cell's: divider, bridge or matrix.
        nets: Pins of each by its name.
        leads: Soldered wires, by cell; none of a sheet.
        bought: What is ordered, without cells.
        channels: Of each taxel in the layout's order: where it is read, as U2.C3, or R1 C4 of a sheet.
        tail: Nets of a sheet's tail, line by line; "" is a spare one.
    """

    circuit: str
    nets: dict[str, tuple[Pin, ...]]
    leads: tuple[Lead, ...]
    bought: tuple[Bought, ...]
    channels: tuple[str, ...]
    tail: tuple[str, ...] = ()

    def net_of(self, pin: Pin) -> str:
        """Name of a pin's net; KeyError if it has none."""
        return {p: name for name, pins in self.nets.items() for p in pins}[pin]


def wiring_of(shoe: Shoe, parameters: ShoeParameters, tail: tuple[str, ...] = ()) -> Wiring | None:
    """Gives the wiring of a shoe, by parameters; None of a laboratory's cells, whose wiring is not published, and of
    cells without ways for a cable. `tail`: nets of a sheet's tail, line by line. Raises FootError for more cells
    than one board reads.
    """
    cell = shoe.plan.cell
    if cell is None or cell.circuit == "own" or not shoe.plan.connectors:
        return None
    refuse_too_many(shoe.plan)
    if cell.circuit == "matrix":
        return _matrix(shoe, tail)
    lengths = lead_lengths(shoe.plan, parameters)
    ids = shoe.layout.ids.tolist()
    return _dividers(ids, lengths) if cell.circuit == "divider" else _bridges(cell, ids, lengths)


def _multiplexers(used: Iterable[int]) -> Iterator[tuple[str, Pin]]:
    """Nets and pins of multiplexers 0 (U2) to 2 (U4), and of U1 for them."""
    for n in used:
        part = f"U{2 + n}"
        yield "3V3", Pin(part, "VCC")
        yield "GND", Pin(part, "GND")
        yield "GND", Pin(part, "EN")
        yield f"A{n}", Pin(part, "SIG")
        yield f"A{n}", Pin("U1", _ANALOG[n])
        for k, pin in enumerate(_SELECT):
            yield f"S{k}", Pin(part, f"S{k}")
            yield f"S{k}", Pin("U1", pin)


def _gathered(pins: list[tuple[str, Pin]]) -> dict[str, tuple[Pin, ...]]:
    nets: dict[str, dict[Pin, None]] = {}
    for name, pin in [("3V3", Pin("U1", "3V3")), ("GND", Pin("U1", "GND")), *pins]:
        nets.setdefault(name, {})[pin] = None
    return {name: tuple(found) for name, found in nets.items()}


def _dividers(ids: list[int], lengths: list[float]) -> Wiring:
    count = -(-len(ids) // CHANNELS)
    pins = list(_multiplexers(range(count)))
    leads = []
    channels = []
    for k, (taxel, length) in enumerate(zip(ids, lengths, strict=True)):
        part = f"T{taxel}"
        channel = Pin(f"U{2 + k // CHANNELS}", f"C{k % CHANNELS}")
        channels.append(str(channel))
        pins += [("3V3", Pin(part, "1")), (part, Pin(part, "2")), (part, channel)]
        pins += [(part, Pin(f"R{taxel}", "1")), ("GND", Pin(f"R{taxel}", "2"))]
        colour = _COLOURS[taxel % len(_COLOURS)]
        leads.append(Lead(taxel, "3V3", Pin(part, "1"), Pin("U1", "3V3"), _SUPPLY, round(length)))
        leads.append(Lead(taxel, part, Pin(part, "2"), channel, colour, round(length)))
    bought = (
        Bought("U1", 1, *_PICO),
        Bought(_span("U", 2, count), count, *_MULTIPLEXER),
        Bought(f"R{ids[0]} to R{ids[-1]}", len(ids), *_RESISTOR),
        *_wires(leads),
        Bought("", 1, *_CABLE),
    )
    return Wiring("divider", _gathered(pins), tuple(leads), bought, tuple(channels))


def lead_colours(cell: Cell) -> dict[str, str]:
    """Colours of a bridge cell's leads by what they are, from a text such as "E+ red, E- black, B+ green, B- white"."""
    words = [part.split() for part in cell.lead_colours.split(",")]
    found = {word[0]: word[1] for word in words if len(word) == 2}
    if set(found) not in ({"E+", "E-", "A+", "A-"}, {"E+", "E-", "B+", "B-"}):
        raise FootError(
            f"cell {cell.label}: lead_colours is {cell.lead_colours!r}; allowed: a colour each of E+, E-, and A+, A- "
            "or B+, B-, the amplifier's pins"
        )
    return found


def _bridges(cell: Cell, ids: list[int], lengths: list[float]) -> Wiring:
    pins = []
    leads = []
    channels = []
    colours = lead_colours(cell)
    for k, (taxel, length) in enumerate(zip(ids, lengths, strict=True)):
        part = f"T{taxel}"
        amplifier = f"U{2 + k}"
        channels.append(f"{amplifier}.DT")
        pins += [("3V3", Pin(amplifier, "VCC")), ("GND", Pin(amplifier, "GND"))]
        pins += [("SCK", Pin(amplifier, "SCK")), ("SCK", Pin("U1", _CLOCK))]
        pins += [(f"DT{taxel}", Pin(amplifier, "DT")), (f"DT{taxel}", Pin("U1", f"GP{k}"))]
        for name, colour in colours.items():
            net = f"{part}{name}"
            pins += [(net, Pin(part, name)), (net, Pin(amplifier, name))]
            leads.append(Lead(taxel, net, Pin(part, name), Pin(amplifier, name), colour, round(length)))
    bought = (
        Bought("U1", 1, *_PICO),
        Bought(_span("U", 2, len(ids)), len(ids), *_AMPLIFIER),
        *_wires(leads),
        Bought("", 1, *_CABLE),
    )
    return Wiring("bridge", _gathered(pins), tuple(leads), bought, tuple(channels))


def _matrix(shoe: Shoe, tail: tuple[str, ...]) -> Wiring:
    plan = shoe.plan
    assert plan.lines is not None
    rows, columns = plan.sheet_lines
    tail = tail or (*(f"R{r}" for r in range(rows)), *(f"C{c}" for c in range(columns)))
    of_columns = -(-columns // CHANNELS)
    # rows are read by the third analog input, whose multiplexer is U4, also where U3 is not needed
    used = [n for n in range(MULTIPLEXERS) if n < of_columns or n == MULTIPLEXERS - 1]
    pins = list(_multiplexers(used))
    channels = []
    for taxel, (row, column) in zip(shoe.layout.ids.tolist(), plan.lines.tolist(), strict=True):
        pins += [(f"R{row}", Pin(f"T{taxel}", "1")), (f"C{column}", Pin(f"T{taxel}", "2"))]
        channels.append(f"R{row} C{column}")
    pins += [(f"R{r}", Pin("U1", f"GP{r}")) for r in range(rows)]
    pins += [(f"R{r}", Pin(f"U{1 + MULTIPLEXERS}", f"C{r}")) for r in range(rows)]
    for c in range(columns):
        pins += [(f"C{c}", Pin(f"U{2 + c // CHANNELS}", f"C{c % CHANNELS}"))]
        pins += [(f"C{c}", Pin(f"RC{c}", "1")), ("GND", Pin(f"RC{c}", "2"))]
    pins += [(net, Pin("J1", str(n))) for n, net in enumerate(tail, start=1) if net]
    bought = (
        Bought("U1", 1, *_PICO),
        Bought(", ".join(f"U{2 + n}" for n in used), len(used), *_MULTIPLEXER),
        Bought(f"RC0 to RC{columns - 1}", columns, *_RESISTOR),
        Bought("J1", 1, *_ADAPTER),
        Bought("X1", 1, *_CONNECTOR),
        Bought(
            "FB1", 1, "OurPCB, or any maker of flexible boards to IPC-2223:",
            f"gerbers_{shoe.side}.zip: 2 layers, polyimide, 0.2 mm with stiffener of 0.3 mm in all at the tail's end, "
            "lines and gaps 0.15 mm, holes 0.2 mm, ENIG",
            "flexible board", "https://www.ourpcb.com/flexible-pcb-capability",
        ),
        Bought("", 1, *_CABLE),
    )  # fmt: skip
    return Wiring("matrix", _gathered(pins), (), bought, tuple(channels), tail)


def _span(letter: str, first: int, count: int) -> str:
    return f"{letter}{first}" if count == 1 else f"{letter}{first} to {letter}{first + count - 1}"


def _wires(leads: list[Lead]) -> Iterator[Bought]:
    for colour in dict.fromkeys(lead.colour for lead in leads):
        metres = 1e-3 * sum(lead.length for lead in leads if lead.colour == colour)
        half = -(-int(2000 * metres) // 1000) / 2.0
        maker, part, address = _WIRE
        yield Bought("", 1, maker, f"{part}, {colour}, {half:g} m", "leads", address)
