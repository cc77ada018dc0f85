"""The field's names: words of forces, places, feet and plates in ten languages, and what a column's name means by them.

A name is cut at signs, digits and capitals ("FzLeft" is Fz and Left), never within a word: each piece is a word of this
dictionary, or one that makers write together ("fzl", "linkervoet"). One unknown piece makes the whole name unknown.
"""

import re
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import chain
from typing import Literal

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.formats.units import FORCES, LENGTHS, MOMENTS, PASCALS, find_unit, plain

Quantity = Literal["force", "pressure", "cop", "moment", "place", "cell", "number", "foreign", "unknown"]
"""What a column holds: "number" is a heading of nothing but side and number, as cells have; "foreign" is known
and no load, such as an angle; "place" is an axis alone, a CoP next to forces; "unknown" has an unknown word."""

OF_PLATES = ("force", "cop", "moment", "place")
OF_CELLS = ("force", "pressure", "cell", "number")
"""Quantities of a plate's columns, and of those of cells."""

BODY_WEIGHTS: dict[str, float] = {
    **dict.fromkeys(("bw", "xbw", "n/bw", "bodyweight", "bodyweights", "timesbodyweight"), 1.0),
    **dict.fromkeys(("%bw", "bw%", "percentbw", "%bodyweight", "%ofbodyweight"), 0.01),
    **dict.fromkeys(("n/kg", "newton/kg", "nkg-1", "n/kgbm"), 1.0 / GRAVITY),
}
"""Units of force relative to the body, in its weights."""

# Where each is seen: OpenSim .mot (ground_force_vx), Cortex .forces (FX1), D-Flow (FP1.ForX), Vicon Nexus (Fx, Force
# Plate #1), BioWare (Ax [m]), BTK (F1X), Visual3D (COFP), AMTI (FX), novel (links, Kraft), loadsol (Force[N]),
# Noraxon (LT), Moticon (total force), OrthoTrak (R_GRF_VRT, R_GRF_FWD), Vernier (Latest: Force), Arduino sketches
# (FSR1, A0, millis), theses in ten languages.
_WORDS_OF_KIND = {
    "left": "l lt li left links linker linke linkes gauche izquierdo izquierda izq sinistro sinistra "
    "esquerdo esquerda 左",
    "right": "r rt re right rechts rechter rechte rechtes droit droite derecho derecha der "
    "destro destra direito direita 右",
    "force": "f force forces for kraft kracht grf grfs load last carga fuerza forza força reaction vgrf 荷重 力",
    "pressure": "pressure druck press pression presion presión kpa 圧力",
    "cop": "cop copp cofp pressurecenter copposition",
    "moment": "freemoment m mom moment moments torque t tz free drehmoment",
    "vertical": "vertical vert vrt v normal vertikal vertikale senkrecht verticale verticaal 垂直",
    "ap": "ap anteroposterior anterior posterior fwd forward",
    "ml": "ml mediolateral lateral lat medial",
    "plate": "fp plate forceplate platform plattform belt treadmill tm ground amti kistler bertec",
    "plain": "net foot feet fuss fuß pied pie piede voet pé 足 leg limb side of the in insole insoles sole shoe "
    "component comp value data latest signal noraxon ultium loadsol",
    "total": "total sum gesamt summe totale tot",
    "cell": "cell cells sensor sens taxel sensel fsr fsrs pad zelle s c p a adc heel hindfoot rearfoot calcaneus mid "
    "midfoot arch met meta metatarsal mt mth forefoot toe toes hallux bigtoe big great ball ferse zehe inner outer mtp "
    "head first fifth second third fourth central front back",
    "foreign": "target analog pos position marker angle angles vel velocity speed acc accel acceleration "
    "accelerometer gyr gyro gyroscope mag magnetometer quat quaternion emg emgs imu angular rate temp "
    "temperature temperatur battery volt voltage "
    "current trigger sync pin frame frames sample index counter count knee hip ankle pelvis trunk power event "
    "phase status flag label subject trial session id participant state step stride cycle roll pitch yaw incline slope "
    "distance area humidity hr off rim handrim wheel handrail finger thumb",
}
_KINDS: dict[str, str] = {w: kind for kind, words in _WORDS_OF_KIND.items() for w in words.split()}
_KINDS |= {axis: axis for axis in "xyz"}
_PLACES = frozenset(w for w, kind in _KINDS.items() if kind == "cell" and len(w) > 1) - {"adc"}
# Words that are written together: a foot before or after what is measured, and an axis.
_FOOT = "left|right|links|rechts|linker|rechter|lt|rt|l|r|左|右"
_WHAT = (
    "force|forces|load|kraft|grfs?|copp?|cofp|moment|mom|torque|total|sum|foot|feet|fuss|fuß|voet|足|leg|insole|sole|"
    "plate|belt|sensor|cell|fsr|heel|hindfoot|rearfoot|mid|midfoot|arch|forefoot|toes?|hallux|met|meta|mth"
)
_TOGETHER = re.compile(
    rf"(?P<foot>{_FOOT})?(?P<before>v|vertical|total)?(?P<what>{_WHAT})(?P<axis>[xyzv])?(?P<after>{_FOOT})?"
    rf"|(?P<foot2>{_FOOT})?(?P<what2>for|f|m|p|v)(?P<axis2>[xyz])(?P<after2>{_FOOT})?"
)
_CAPITALS = re.compile(r"[A-ZÄÖÜ]{2,}(?![a-zß-ÿ])|[A-ZÄÖÜ]?[a-zß-ÿ]+|[A-ZÄÖÜ]")
_UNIT = re.compile(
    r"[\[(<{]\s*([^\])>}]*?)\s*[\])>}]|[_ ](kpa|n|pa|mmhg|psi|raw|kg|lbf|nm|nmm|mm|cm|bw|%bw|newtons?)$", re.I
)
_VOLTS = re.compile(r"(?i)([fm]\d*[xyz]\d*)[_ ](m?v|volts?)$")  # of a plate's channel; after another word v is vertical
_LETTER = re.compile(r"(plate|platform|fp|belt)[ _-]?([a-d])(?![a-z])", re.IGNORECASE)  # instead of a number
_COORDINATE = re.compile(r"\[[0-2]\]\s*$")  # of a marker, as LTOE[0]
# Of BioWare: a place where in m, else an acceleration.
_PLACE_OF_KISTLER = re.compile(r"(?<![a-zA-Z])A([xy]\d*\s*)$")
_ADAPTER = re.compile(r"^([fpm])(\d+)_([123])$")
_STATED = {**FORCES, **PASCALS, **LENGTHS, **MOMENTS, **BODY_WEIGHTS}


@dataclass(frozen=True)
class Heading:
    """Meaning of a heading.

    `axis`: "x", "y", "z", "vertical", "ap" or "ml", or empty; `side`: named foot or None; `number`: last number, of a
    plate or cell, or None; `unit`: as stated, or empty; `plate`: whether a force plate, belt or ground reaction is
    named; `words`: words other than side, number or unit, joined.
    """

    quantity: Quantity
    axis: str = ""
    side: Side | None = None
    number: int | None = None
    unit: str = ""
    plate: bool = False
    words: str = ""


def spelled_out(names: list[str]) -> list[str]:
    """Names of OpenSim's C3DFileAdapter (f1_1 to f1_3, p1_1, m1_1 of plate 1) as FP1 Fx, FP1 COPx, FP1 Mx.

    Example:
        >>> spelled_out(["time", "f1_1", "f1_2", "f1_3", "p1_1", "m1_3"])
        ['time', 'FP1 Fx', 'FP1 Fy', 'FP1 Fz', 'FP1 COPx', 'FP1 Mz']
    """
    if not {"f1_1", "f1_2", "f1_3"} <= set(names):
        return names
    what = {"f": "F", "p": "COP", "m": "M"}
    return [_ADAPTER.sub(lambda m: f"FP{m[2]} {what[m[1]]}{'xyz'[int(m[3]) - 1]}", name) for name in names]


def heading_of(text: str) -> Heading:
    """Meaning of a heading.

    Example:
        >>> h = heading_of("Left Fz (N)"); h.quantity, h.axis, h.side, h.unit
        ('force', 'z', 'left', 'N')
        >>> h = heading_of("2_ground_force_vy"); h.quantity, h.axis, h.number, h.plate
        ('force', 'y', 2, True)
        >>> [heading_of(t).quantity for t in ("FP1.CopX", "ground_torque_z", "met5", "R_12", "LHEE.PosX", "knee angle")]
        ['cop', 'moment', 'cell', 'number', 'unknown', 'foreign']
    """
    name = _LETTER.sub(lambda m: f"{m[1]} {ord(m[2].lower()) - 96} ", text.strip().strip('"'))
    name = _VOLTS.sub(r"\1 [\2]", name)
    unit = ""
    while match := _UNIT.search(name):
        stated = match[1] if match[1] is not None else match[2]
        known = plain(stated) in _STATED or find_unit(stated) is not None or "/" in stated or "%" in stated
        if known or not _words(stated):
            unit = unit or stated
            name = name[: match.start()] + " " + name[match.end() :]
        else:
            name = name[: match.start()] + " " + stated + " " + name[match.end() :]
    if plain(unit) in LENGTHS:
        name = _PLACE_OF_KISTLER.sub(r"COP\1", name)
    found = _heading(name, unit)
    of_marker = _COORDINATE.search(text) is not None and not _PLACES.isdisjoint(found.words.split())
    return replace(found, quantity="foreign") if of_marker else found


@lru_cache(maxsize=4096)
def _words(name: str) -> tuple[str, ...] | None:
    """Name's known words and numbers; None with any other."""
    out: list[str] = []
    for chunk in re.findall(r"[^\W\d_]+|\d+|%", name):
        words = _known(chunk) if chunk.isalpha() else [chunk]
        if not words:
            return None
        out += words
    return tuple(out)


def _known(letters: str) -> list[str]:
    """Known words of letters: one, one written together, or one from each capital on; empty with an unknown one."""
    for pieces in ([letters], _CAPITALS.findall(letters)):
        words = [_one_word(piece.lower()) for piece in pieces]
        if all(words) and "".join(pieces) == letters:
            return list(chain(*words))
    return []


def _one_word(text: str) -> list[str]:
    if text in _KINDS:
        return [text]
    match = _TOGETHER.fullmatch(text)
    return [part for part in match.groups() if part] if match else []


def _heading(name: str, unit: str) -> Heading:
    words = _words(name)
    last = re.findall(r"\d+", name)
    number = int(last[-1][-9:]) if last else None
    if words is None:
        letters = "".join(re.findall(r"[^\W\d_]+", name)).lower()
        return Heading("unknown", number=number, unit=unit, words=letters)
    kinds = [_KINDS.get(w, "number") for w in words]
    sides = [side for side in SIDES if side in kinds]
    side = sides[0] if len(sides) == 1 else None
    found = set(kinds)
    rest = " ".join(w for w, k in zip(words, kinds, strict=True) if k not in ("left", "right", "number", "plain"))
    axis = next((k for k in kinds if k in ("x", "y", "z", "ap", "ml")), "vertical" if "vertical" in found else "")
    ground = not {"ground", "grf", "vgrf", "reaction"}.isdisjoint(words)
    if {"force", "moment"} & found and len(last) == 2 and axis:
        number = int(last[0][-9:])  # F2Y1 is of plate 2
    if not ground and "plate" not in found and {"medial", "lateral", "anterior", "posterior"} & set(words):
        axis = ""  # a part of the sole, not an axis
        found |= {"place"}
    plate = "plate" in found or ground or ("force" in found and bool(axis))
    return Heading(_quantity(words, found, axis, ground), axis, side, number, unit, plate, rest)


def _quantity(words: tuple[str, ...], found: set[str], axis: str, ground: bool) -> Quantity:
    # The first that fits; the clearest come first.
    cells = any(w in _PLACES for w in words) and "plate" not in found and axis in ("", "ml", "ap")
    alone = {"a", "c", "p", "l", "r", "left", "right", *filter(str.isdigit, words)}
    if "foreign" in found:
        return "foreign"
    of_plate = "plate" in found and {"a", "c", "p"} & set(words) and not {"force", "moment"} & found
    if axis in ("x", "y", "z") and (set(words) - {axis} <= alone or of_plate):
        return "place"
    if "place" in found or cells:
        return "cell"
    if "cop" in found or {"pressure", "center"} <= set(words) or ("ground" in words and "p" in words):
        return "cop"
    # As ground_force_m1_x, of a file whose headings all begin with the force's words.
    last = bool(axis) and words[-1] in ("m", *"xyz") and not {"m", "mom", "moment", "torque"}.isdisjoint(words)
    if "tz" in words or ("moment" in found and ("force" not in found or last)):
        return "moment"
    if "force" in found or ("vertical" in found and not {"cell", "pressure"} & found) or (ground and axis):
        return "force"
    if "pressure" in found:
        return "pressure"
    if "total" in found:
        return "force"
    if "cell" in found:
        return "foreign" if axis in ("x", "y", "z") else "cell"
    if axis:
        return "force" if "plate" in found else "foreign"
    return "number"
