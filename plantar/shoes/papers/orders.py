"""What to ask a shop or workshop for: prints, foam, silicone, straps, boards and screws. Lengths in mm.

Each is named by what any maker offers (a standard, or material, process and size) and by one maker's product, with the
address of a page that describes it.
"""

from typing import NamedTuple

from plantar.errors import InputError
from plantar.shoes.parameters import ShoeParameters


class Order(NamedTuple):
    """Text of an order, and the address of a product or of what a workshop offers."""

    text: str
    address: str


_PRINTS = {
    ("PA12", "MJF"): (
        "HP PA 12, Multi Jet Fusion (3faktur)",
        "https://3faktur.com/en/design-guidelines-and-design-optimizations-for-plastic-3d-printing/",
    ),
    ("PA12", "SLS"): (
        "PA 12, laser sintering (Materialise)",
        "https://www.materialise.com/es/academy/industrial/design-am/pa12-sls",
    ),
    ("PETG", "FDM"): (
        "PETG filament of 1.75 mm (OWL-Filament)",
        "https://owl-filament.de/filament-coil/petg-1-75-mm-en/petg-RAL-default-colours/",
    ),
    ("PLA", "FDM"): ("PLA filament of 1.75 mm (OWL-Filament)", "https://owl-filament.de/"),
    ("TPU", "FDM"): (
        "TPU filament of 95 Shore A (Recreus Filaflex 95A)",
        "https://recreus.com/en/pages/how-to-print-flexible-filament-or-tpu-filaflex",
    ),
    ("resin", "SLA"): ("Formlabs Tough 2000 resin", "https://formlabs.com/blog/formlabs-tough-challenge-videos"),
}
_ANY_PRINT = "https://www.sculpteo.com/en/materials/materials-design-guidelines/"

# Upper ends in kPa at 25 % of the grades of ASTM D1056; foams of `plan.touching` are these, and between
_GRADES = ((14.0, 0), (35.0, 1), (63.0, 2), (92.0, 3), (120.0, 4), (176.0, 5))
_GRADE_1 = ("Jacobs & Thompson 1040", "https://www.foamparts.com/materials/1040/")
_OTHER_GRADES = ("Stockwell Elastomerics", "https://www.stockwell.com/poron-foam-cellular-urethane/")

# Shore A of two-part platinum silicones
_SILICONES = {
    10.0: "Dragon Skin 10",
    20.0: "Dragon Skin 20",
    30.0: "Dragon Skin 30",
    40.0: "Smooth-Sil 940",
    50.0: "Smooth-Sil 950",
    60.0: "Smooth-Sil 960",
}
_SILICONE = (
    "https://www.reynoldsam.com/faq/do-you-have-a-rubber-that-is-food-safe-for-casting-chocolate-and-other-food-items/"
)

_GLUE = "https://dge-europe.com/dowsil-silicone-sealants-foams-industrial-appliance-maintenance"

_STRAPS = (20.0, 25.0, 30.0, 50.0)  # widths that rolls of hook and loop have
_STRAP = "https://www.velcro.co.uk/"
_BOARD = "https://github.com/sparkfun/PTH_protoboard_30"
_BOARD_THICKNESS = 1.6

_LENGTHS = (2, 2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 35, 40, 45, 50, 55, 60)  # of ISO 4026
_SET_SCREW = "https://www.westfieldfasteners.co.uk/Standards/ScrewBolt_GrubFlat_M.html"
_NUT = "https://www.trojansf.co.uk/standards/iso-4032"


def print_order(file: str, parameters: ShoeParameters) -> Order:
    """Gives order of a print of a file, by parameters.

    Example:
        >>> print_order("shoe_left.step", ShoeParameters()).text
        'print of shoe_left.step in HP PA 12, Multi Jet Fusion (3faktur)'
    """
    p = parameters
    what, address = _PRINTS.get((p.material, p.made_by.name), (f"{p.material}, {p.made_by.name}", _ANY_PRINT))
    return Order(f"print of {file} in {what}", address)


def foam_order(parameters: ShoeParameters) -> Order:
    """Gives order of the pad's foam, by parameters.

    Example:
        >>> foam_order(ShoeParameters(pad_foam=35.0)).text
        'sponge rubber, ASTM D1056 grade 2A1, 35 kPa or less at 25 %, sheets of 2 and 2.1 mm (Jacobs & Thompson 1040)'
    """
    p = parameters
    grade = next((number for most, number in _GRADES if p.pad_foam <= most), None)
    standard = "" if grade is None else f", ASTM D1056 grade 2A{grade}"
    maker, address = _GRADE_1 if grade == 1 else _OTHER_GRADES
    sheets = f"sheets of {' and '.join(f'{t:g}' for t in (p.pad_thickness, p.pad_rim_height) if t > 0.0)} mm"
    return Order(f"sponge rubber{standard}, {p.pad_foam:g} kPa or less at 25 %, {sheets} ({maker})", address)


def silicone_order(side: str, parameters: ShoeParameters) -> Order:
    """Gives order of the silicone that a side's pad is cast of, by parameters."""
    hardness = parameters.pad_hardness
    nearest = min(_SILICONES, key=lambda known: abs(known - hardness))
    named = f" (Smooth-On {_SILICONES[nearest]})" if abs(nearest - hardness) <= 5.0 else ""
    text = f"two-part silicone of {hardness:g} Shore A{named}; mould_{side}.stl printed in any material"
    return Order(text, _SILICONE)


def glue_order() -> Order:
    """Order of what cells and pad are glued with: it stays soft, and does not corrode leads as acetic silicone does."""
    return Order("one-part silicone that cures neutrally, no acetic one (Dow, DOWSIL sealants)", _GLUE)


def strap_order(width: float) -> Order:
    """Gives order of hook-and-loop strap of a width.

    Example:
        >>> strap_order(16.7).text
        'VELCRO ONE-WRAP, hook and loop back to back, 20 mm, cut to 16.7 mm'
    """
    sold = next((w for w in _STRAPS if w >= width), _STRAPS[-1])
    cut = "" if sold == width else f", cut to {width:g} mm"
    return Order(f"VELCRO ONE-WRAP, hook and loop back to back, {sold:g} mm{cut}", _STRAP)


def board_order(parameters: ShoeParameters) -> Order:
    """Gives order of the connection board, by parameters."""
    thickness = parameters.board_thickness
    named = "SparkFun PRT-12070, cut to size" if thickness == _BOARD_THICKNESS else "cut to size"
    return Order(f"prototyping board, FR4 (IPC-4101), {thickness:g} mm: {named}", _BOARD)


def screw_length(least: float) -> float:
    """Gives length of a set screw that is made and at least as long.

    Example:
        >>> screw_length(11.0)
        12
    """
    if least > _LENGTHS[-1]:
        raise InputError(f"a set screw of {least:g} mm is not made; allowed: up to {_LENGTHS[-1]} mm (rim_thickness)")
    return next(length for length in _LENGTHS if length >= least)


def screw_order(diameter: float, length: float) -> Order:
    """Gives order of a set screw."""
    return Order(f"set screw ISO 4026, M{diameter:g} x {length:g} (DIN 913, flat point)", _SET_SCREW)


def nut_order(diameter: float) -> Order:
    """Gives order of a nut."""
    return Order(f"hexagon nut ISO 4032, M{diameter:g}", _NUT)
