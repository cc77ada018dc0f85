"""Rate that a file states in words."""

import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.units import seconds_of_unit
from plantar.recordings.pressure_recording import possible_rate

_USUAL = 100.0
# What has a rate of frames; with other words it is that of a heart, of steps, of a filter.
_OF = (
    "(?:the|an?|of|d|de|di|du|sampl(?:e|es|ing)|frames?|data|scan(?:ning)?|record(?:ing)?|measure(?:ment|d)?|acquisition|"
    "capture|sensors?|device|force|plates?|insoles?|pressure|analog|nominal|original|video|abtast|mess|bild|aufnahme|"
    "échantillonnage|muestreo|campionamento|bemonsterings?|amostragem|サンプリング)*"
)
_RATE = re.compile(
    rf"{_OF}(?:rate|freq|frequency|frequenz|fréquence|frecuencia|frequenza|frequentie|frequência|taxa|周波数){_OF}(?:in)?"
    r"|(?:samples|frames|images|pictures|points)per(?:s|sec|second)|fs|fps|sps|k?hz|sampling"
)
_PERIOD = re.compile(
    r"(?:sampl(?:e|es|ing)|frames?|scan(?:ning)?|abtast)(?:intervall?|periode?|step|spacing)(?:in)?"
    r"|d(?:elta)?t|timestep|zeitschritt|frametime|(?:seconds?|secs?|s|ms|time)per(?:frame|sample|picture|image)"
)
_HERTZ = {"hz": 1.0, "hertz": 1.0, "khz": 1e3, "fps": 1.0, "sps": 1.0} | {
    f"{what}per{of}": 1.0 / seconds_of_unit(of)
    for what in ("", "sample", "samples", "frame", "frames")
    for of in ("s", "sec", "second", "min", "minute")
}
_STATED = re.compile(r"(\D*?)([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[-+]?\d+)?)((?![\d.:-]).*)", re.DOTALL)
_STEPS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"))
_THOUSANDS = re.compile(r"[1-4][.,]\d{3}")  # Hz: no gait is seen in four frames a second


def stated_rate(facts: Mapping[str, str], warnings: list[str]) -> float | None:
    """Returns rate in Hz by the first of named facts that states it or a frame's time; None without.

    The unit decides which, else the name; warnings get assumptions. FormatError for no number, or outside RATES.

    Example:
        >>> [stated_rate({k: v}, []) for k, v in (("Rate", "0.2 kHz"), ("dt [ms]", "5"), ("heart rate", "60"))]
        [200.0, 200.0, None]
    """
    found: dict[str, float] = {}
    for name, text in facts.items():
        words = _words(_clear(name))
        shown = f"{name!r} of {text[:40]!r}"
        end = next((k for k in range(len(words), 0, -1) if _is_stated(words[:k], words[k:])), 0)
        columns = {part.strip() for part in re.split("[\t;]", text) if part.strip()}
        stated = _STATED.fullmatch(_clear(columns.pop() if len(columns) == 1 else text))  # BioWare: one a column
        if not end or not text.strip() or (found and stated is None):
            continue
        if stated is None:
            raise FormatError(
                f"{name!r} is no number of frames a second or s a frame: {text[:40]!r} (--rate overrides)"
            )
        before = stated[1]
        value = float(stated[2].replace(",", "."))
        rest = _words(re.split(r"\d", stated[3])[0])
        unit = next((u for k in range(len(rest), 0, -1) if _is_unit(u := "".join(rest[:k]))), "")
        odd = bool(before or (stated[3].strip(" ,;\t") and not unit))
        unit = unit or "".join(words[end:]) or (words[0] if _is_unit(words[0]) else "")
        if not unit and _PERIOD.fullmatch("".join(words)):
            unit, odd = ("s", odd) if value < 1.0 else ("ms", True)  # a frame a second is no gait
        if _THOUSANDS.fullmatch(stated[2]) and _HERTZ.get(unit or "hz") == 1.0:
            value = 1e3 * value
            odd = True
        if odd:
            warnings.append(f"{shown} is not clear, taken as {value:g} {unit or 'Hz'}: check the rate")
        period = value * seconds_of_unit(unit)
        rate = value * _HERTZ.get(unit, 1.0) if unit in _HERTZ or not unit else 1.0 / period if period else np.inf
        found[name] = possible_rate(rate, f"{shown} means")
    chosen = min(found, key=lambda name: "video" in name or "marker" in name, default="")
    if found and max(found.values()) > 1.01 * min(found.values()):
        several = ", ".join(f"{name} {rate:g} Hz" for name, rate in found.items())
        warnings.append(f"the file states several rates, {several}: {chosen} is taken (--rate overrides)")
    return found.get(chosen)


def or_usual(rate: float | None, without: str, warnings: list[str]) -> float:
    """Returns rate in Hz, else the usual one; warnings tell what the file is without."""
    if rate is None:
        warnings.append(
            f"{without}: {_USUAL:g} Hz is assumed; at half of that all times are twice as long (--rate overrides)"
        )
    return rate or _USUAL


def in_seconds(
    time: NDArray[np.float64], unit: float | None, stated: float | None, warnings: list[str], longest: float = 1.0
) -> NDArray[np.float64]:
    """Returns `time` (n,) in s; warnings get an assumed unit (frames last up to longest); counts of `stated` stay."""
    if not unit:
        steps = np.diff(time[np.isfinite(time)])
        step = float(np.median(steps)) if len(steps) else 0.0
        unit, name = next((u for u in _STEPS if u[0] * step < 1.0), _STEPS[-1])
        if unit * step > longest or (stated and step == 1.0):
            return time
        if unit < 1.0 or longest == 1.0:
            warnings.append(f"the times state no unit: {name} is assumed")
    return time * unit


def _clear(text: str) -> str:  # with "per" for a stroke or a power of -1
    text = text.strip().lower().replace("μ", "u").replace("µ", "u")
    return re.sub(r"(?<![^\W\d_])s\s*\^?\s*(?:-1|⁻¹)|\b1\s*/\s*s\b", " per s", text).replace("/", " per ")


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W\d_]+", text)


def _is_unit(text: str) -> bool:
    return text in _HERTZ or seconds_of_unit(text) > 0.0


def _is_stated(name: list[str], unit: list[str]) -> bool:
    known = _RATE.fullmatch("".join(name)) or _PERIOD.fullmatch("".join(name))
    return known is not None and (not unit or _is_unit("".join(unit)))
