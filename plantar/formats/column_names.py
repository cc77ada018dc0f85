"""Meaning of a heading: quantity, axis, foot or plate, and unit.

A heading is cut into known words ("FzLeft" is force, z, left; "1_ground_force_vy" is 1, ground, force, y); one unknown
word makes it unknown.
"""

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from plantar.common.sides import Side
from plantar.formats.units import FORCES, LENGTHS, MOMENTS, PASCALS, find_unit, plain

Quantity = Literal["force", "pressure", "cop", "moment", "place", "cell", "number", "foreign", "unknown"]
"""What a column holds: "number" is a heading of nothing but side and number, as cells have; "foreign" is known
and no load, such as an angle; "place" is an axis alone, a CoP next to forces; "unknown" is a word that is not known."""

BODY_WEIGHTS: dict[str, float] = {
    **dict.fromkeys(("bw", "xbw", "n/bw", "bodyweight", "bodyweights", "timesbodyweight"), 1.0),
    **dict.fromkeys(("%bw", "bw%", "percentbw", "%bodyweight", "%ofbodyweight"), 0.01),
}
"""Units of force relative to the body's weight; N/kg is apart, since it is of the mass."""

_WORDS_OF_KIND = {
    "left": "l left links linker linke li gauche izquierdo izquierda izq sinistro sinistra lt esquerdo esquerda 左",
    "right": "r right rechts rechter rechte re droit droite derecho derecha der destro destra rt direito direita 右",
    "force": "f force forces for kraft kracht grf grfs load last fuerza forza força reaction vgrf 荷重 力",
    "pressure": "pressure druck press pression presion presión kpa 圧力",
    "cop": "cop copp pressurecenter copposition",
    "moment": "m mom moment moments torque t tz free drehmoment",
    "vertical": "vertical vert v normal vertikal vertikale senkrecht verticale verticaal 垂直",
    "ap": "ap anteroposterior anterior posterior",
    "ml": "ml mediolateral lateral medial",
    "plate": "fp plate forceplate platform plattform belt treadmill tm ground amti kistler bertec",
    "plain": "net foot feet fuss fuß pied pie piede voet pé 足 leg limb side of the in insole insoles sole shoe "
    "component comp value data signal ch noraxon ultium loadsol",
    "total": "total sum gesamt summe totale tot",
    "cell": "cell cells sensor sens taxel sensel fsr fsrs pad zelle s c p a adc heel hindfoot rearfoot calcaneus mid "
    "midfoot arch met meta metatarsal mt mth forefoot toe toes hallux bigtoe big great ball ferse zehe inner outer mtp "
    "head first fifth second third fourth central front back",
    "foreign": "pos position marker angle angles vel velocity speed acc accel acceleration accelerometer gyr gyro "
    "gyroscope mag magnetometer quat quaternion emg emgs imu angular rate temp temperature temperatur battery volt "
    "voltage current trigger sync pin frame frames sample index counter count knee hip ankle pelvis trunk power event "
    "phase status flag label subject trial session id participant state step stride cycle roll pitch yaw incline slope "
    "distance area humidity hr off",
}
_KINDS: dict[str, str] = {w: kind for kind, words in _WORDS_OF_KIND.items() for w in words.split()}
_KINDS |= {axis: axis for axis in "xyz"}
_PLACES = frozenset(w for w, kind in _KINDS.items() if kind == "cell" and len(w) > 1) - {"adc"}
_LONGEST = max(map(len, _KINDS))
_SHORT = {"s", "c", "p", "a", "li", "re", "der"}  # Words of which many others could be put together, such as Czas
_UNIT = re.compile(
    r"[\[(<{]\s*([^\])>}]*?)\s*[\])>}]|[_ ](kpa|n|pa|mmhg|psi|raw|kg|lbf|nm|nmm|mm|cm|bw|%bw|newtons?)$", re.I
)
_LETTER = re.compile(r"(plate|platform|fp|belt)[ _-]?([a-d])(?![a-z])", re.IGNORECASE)  # instead of a number
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


def heading_of(text: str) -> Heading:
    """Meaning of a heading.

    Example:
        >>> h = heading_of("Left Fz (N)"); h.quantity, h.axis, h.side, h.unit
        ('force', 'z', 'left', 'N')
        >>> h = heading_of("2_ground_force_vy"); h.quantity, h.axis, h.number, h.plate
        ('force', 'y', 2, True)
        >>> [heading_of(t).quantity for t in ("FP1.CopX", "ground_torque_z", "met5", "R_12", "LHEE.PosX", "knee angle")]
        ['cop', 'moment', 'cell', 'number', 'foreign', 'foreign']
    """
    name = _LETTER.sub(lambda m: f"{m[1]} {ord(m[2].lower()) - 96} ", text.strip().strip('"'))
    unit = ""
    while match := _UNIT.search(name):
        stated = match[1] if match[1] is not None else match[2]
        known = plain(stated) in _STATED or find_unit(stated) is not None or "/" in stated or "%" in stated
        if known or not _words(stated):
            unit = unit or stated
            name = name[: match.start()] + " " + name[match.end() :]
        else:
            name = name[: match.start()] + " " + stated + " " + name[match.end() :]
    return _heading(name, unit)


@lru_cache(maxsize=4096)
def _words(name: str) -> tuple[str, ...] | None:
    """Name's known words and numbers; None with any other."""
    out: list[str] = []
    for chunk in re.findall(r"[^\W_]+|%", name):
        parts = _cut(chunk)
        if parts is None:
            return None
        out += parts
    return tuple(out)


def _cut(chunk: str) -> list[str] | None:
    """Letters and digits as known words and numbers: cut at case changes, then into the fewest fitting words."""
    spans = re.findall(r"[A-Z]{2,}(?![a-zß-ÿ])|[A-Z]?[a-zß-ÿ]+|[A-Z]|\d+", chunk)
    cased = [_fewest(span.lower()) if not span.isdigit() else [span] for span in spans]
    if all(part is not None for part in cased) and "".join(spans) == chunk:
        by_case = [word for part in cased if part is not None for word in part]
        whole = _fewest(chunk.lower())
        return by_case if whole is None or len(by_case) <= len(whole) else whole
    return _fewest(chunk.lower())


def _fewest(text: str) -> list[str] | None:
    best: list[list[str] | None] = [[]] + [None] * len(text)
    for end in range(1, len(text) + 1):
        for begin in range(max(0, end - _LONGEST), end):
            before = best[begin]
            word = text[begin:end]
            split_number = word.isdigit() and (end < len(text) and text[end].isdigit())
            if before is None or split_number or not (word in _KINDS or word.isdigit()):
                continue
            if best[end] is None or len(before) + 1 < len(best[end] or []):
                best[end] = [*before, word]
    letters = [word for word in best[-1] or () if not word.isdigit()]
    short = [w for w in letters if w in _SHORT]
    beside = [w for w in letters if len(w) < 3 and w not in _SHORT]
    unlikely = short and (len(short) > 1 or len(set(beside)) < len(beside) or not set(beside) <= set("lrxyz"))
    return None if unlikely else best[-1]


def _heading(name: str, unit: str) -> Heading:
    words = _words(name)
    last = re.findall(r"\d+", name)
    number = int(last[-1][-9:]) if last else None
    if words is None:
        letters = "".join(re.findall(r"[^\W\d_]+", name)).lower()
        return Heading("foreign" if _is_foreign(name, letters) else "unknown", number=number, unit=unit, words=letters)
    kinds = [_KINDS.get(w, "number") for w in words]
    sides = {k for k in kinds if k in ("left", "right")}
    side: Side | None = None if len(sides) != 1 else "left" if "left" in sides else "right"
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


def _is_foreign(name: str, letters: str) -> bool:
    chunks = re.findall(r"[A-Z]?[a-z]+|[A-Z]+", name)
    return any(_KINDS.get(chunk.lower()) == "foreign" for chunk in chunks) or any(
        w in letters for w, kind in _KINDS.items() if kind == "foreign" and len(w) > 3
    )


def _quantity(words: tuple[str, ...], found: set[str], axis: str, ground: bool) -> Quantity:
    # The first that fits, the most telling first.
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
        return "cell"
    if axis:
        return "force" if "plate" in found else "foreign"
    return "number"
