"""Force plates as feet: zero, sign, CoP, and the foot of each contact.

Laboratory axes, z up; loads are on the foot.
"""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError, InputError
from plantar.formats.belts import are_belts
from plantar.formats.format import ReadOptions
from plantar.formats.plate_sides import LEAST, Plate, PlateContact, plate_contacts, sides_of_contacts
from plantar.recordings.pressure_recording import FootRecording, StatedEvents, true_runs

# An empty plate reads less than 0.15 of its peak, or 60 N; else the commonest level is its own, if it is an end.
_WINDOW = 0.15
_WINDOW_N = 60.0
# Share of frames on one side of a level that is an end; share of the range in which an empty plate drifts.
_ONE_SIDE = 0.98
_FAR = 0.05
# Largest scatter of an end's level, as a share of half the range: of a wave's turning point it is 0.1 and more.
_FLAT = 0.05
# Time in s of a run of empty frames, and their least share, from which they show the plate's zero.
_SHORTEST = 0.1
_FEWEST = 0.02
_FOOT = (0.45, 0.16)  # Length and width in m that the CoP of one foot covers at most
_NOISES = 6.0
# Horizontal over vertical force, median of loaded frames, above which what pushes is no foot: friction of shoes on
# floors allows 0.5, walking has 0.1.
_SHEAR = 0.6
# Share of loaded frames whose CoP is outside the plate by more than 0.05 m from which its geometry is doubted.
_OUTSIDE = 0.3
_EDGE = 0.05
_BRINK = 0.01  # Distance in m of the CoP from a plate's edge below which a part of the foot may be off it
# Time in s before and after a contact in which its plate is read: another plate's drift is no load of this foot.
_BESIDE = 0.3
_STATED = 2.0  # Offset in N from which it is reported
# Gap in s between contacts of one plate below which it is a run's flight, and no foot was swung meanwhile: a sprinter's
# swing takes 0.3 s, the flight of a run 0.02 to 0.2 s. Shorter ones are chatter of a foot that lands.
_SWING = 0.25
_BRIEF = 0.15  # Gap in s over which a foot counts as in contact (`MINIMUM_SWING` of gait.analysis): no step is found
_CHATTER = 0.015
_A_PLATE_EACH = "allowed: a plate for each foot"


def feet_of_plates(
    plates: Sequence[Plate],
    rate: float,
    options: ReadOptions,
    warnings: list[str],
    markers: Mapping[Side, NDArray[np.float64]] | None = None,
    events: Mapping[Side, StatedEvents] | None = None,
) -> tuple[dict[Side, FootRecording], bool]:
    """Returns feet on force plates, and whether plates see every step, as a treadmill's do.

    Each plate's zero is the mean of its empty frames; its sign that of its load.

    `markers`: each foot's markers (n, 2) in m, NaN if unseen; `events`: each foot's stated heel strikes in s from the
    first frame.
    """
    if options.plates and len(options.plates) != len(plates):
        raise InputError(f"--plates names {len(options.plates)} plates; the file has {len(plates)}")
    named = [replace(p, side=s) for p, s in zip(plates, options.plates or [p.side for p in plates], strict=True)]
    chosen = [p for p, s in zip(named, options.plates or ["all"] * len(named), strict=True) if s is not None]
    ready = [_zeroed(p, rate, warnings) for p in _alive(chosen, warnings)]
    used = [p for p in ready if p.stepped]
    if not used:
        raise FormatError(f"no force plate carries more than {LEAST:g} N")
    if len(used) < len(ready):
        warnings.append(f"{len(ready) - len(used)} of {len(ready)} force plates are never stepped on")
    for plate in used:
        _refuse_no_foot(plate)
    used = [on_its_surface(p, warnings) for p in used]
    contacts = [c for i, p in enumerate(used) for c in plate_contacts(i, p.force[:, 2], rate)]
    if len(used) == 1 and not contacts and float(np.nanpercentile(used[0].force[:, 2], 2.0)) > LEAST:
        spread = float(np.nanstd(used[0].force[:, 2]) / np.nanmean(used[0].force[:, 2]))
        if spread > 0.1:
            raise FormatError(
                f"{used[0].name} is never empty and its load changes by {100.0 * spread:.0f} %: both feet walk on one "
                f"plate, which does not separate them; {_A_PLATE_EACH}"
            )
    if len(used) == 1:
        _doubt_run(used[0], rate, warnings)
    for plate in used:
        _doubt_one_foot(plate, markers or {}, warnings)
    every = are_belts(used, contacts, rate, warnings)
    both = [] if every else [c for c in contacts if used[c.plate].side is None and _is_of_both(used[c.plate], c)]
    if both:
        names = ", ".join(f"{used[c.plate].name} at {c.begin / rate:.1f} s" for c in both[:5])
        text = f"both feet are on one plate ({names}): its centre of pressure goes farther than a foot is long or wide"
        if len(both) == len(contacts):
            raise FormatError(
                f"{text}; allowed: a plate for each foot, or --plates, which names the foot of each plate"
            )
        warnings.append(f"{text}; left out, and a step that is partly on another plate is too small there")
    found = sides_of_contacts(used, contacts, every, rate, options.side, warnings, markers, events)
    sides = [None if c in both else s for c, s in zip(contacts, found, strict=True)]
    weights = _weights(used, contacts, sides, round(_BESIDE * rate))
    return {side: _foot(side, used, weights[side]) for side in SIDES if side in weights}, every


def _alive(plates: Sequence[Plate], warnings: list[str]) -> list[Plate]:
    """Plates less those that read one force in every frame while others change."""
    ranges = [
        float(np.nanmax(p.force[:, 2], initial=-np.inf) - np.nanmin(p.force[:, 2], initial=np.inf)) for p in plates
    ]
    alive = [p for p, moved in zip(plates, ranges, strict=True) if moved > 0.0]
    stuck = [p for p, moved in zip(plates, ranges, strict=True) if moved == 0.0 and abs(p.force[0, 2]) > LEAST]
    if not alive or not stuck:
        return list(plates)
    names = ", ".join(f"{p.name} {p.force[0, 2]:.4g} N" for p in stuck)
    warnings.append(f"what reads one force in every frame, as a plate without power, is left out: {names}")
    return [p for p in plates if p not in stuck]


def _zeroed(plate: Plate, rate: float, warnings: list[str]) -> Plate:
    vertical = plate.force[:, 2]
    empty = _empty_frames(vertical, rate)
    force = plate.force
    moment = plate.moment
    free = plate.free
    noise = 0.0
    if empty is not None:
        zero = _zero(force, empty)
        force = force - zero
        noise = float(np.nanstd(force[empty, 2]))
        moment = None if moment is None else moment - _zero(moment, empty)
        free = None if free is None else free - _zero(free[:, None], empty)[:, 0]
        drift = float(np.ptp(zero[:, 2]))
        if drift > _STATED or abs(float(zero[:, 2].mean())) > _STATED:
            moves = f" and drifts by {drift:.3g} N" if drift > _STATED else ""
            warnings.append(
                f"{plate.name} reads {zero[:, 2].mean():.3g} N when empty{moves}: the mean of its own "
                f"{int(empty.sum())} empty frames is taken off its forces and moments"
            )
    elif np.nanmax(np.abs(vertical), initial=0.0) > LEAST:
        warnings.append(f"{plate.name} is never empty: its zero is taken as it is")
    least = max(LEAST, _NOISES * noise)
    loaded = np.abs(np.nan_to_num(force[:, 2])) > least
    if loaded.sum() < max(3, _SHORTEST * rate):
        return replace(plate, force=force, moment=moment, stepped=False)
    if float(np.nanmedian(force[loaded, 2])) < 0.0:
        warnings.append("the plates' forces point down: taken as those on the plate, and turned to those on the foot")
        force = -force
        moment = None if moment is None else -moment
        free = None if free is None else -free
    return replace(plate, force=force, moment=moment, free=free, stepped=True)


def _zero(values: NDArray[np.float64], empty: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Empty reading of columns (n, k): lines between means of empty runs where these differ, else one mean."""
    known = np.where(np.isfinite(values), values, 0.0)
    out = np.tile(known[empty].mean(axis=0), (len(values), 1))
    halves = [(a, b) for c, d in true_runs(empty) for a, b in ((c, (c + d) // 2), ((c + d) // 2, d)) if b - a > 1]
    means = np.array([known[a:b].mean(axis=0) for a, b in halves])
    scatter = np.mean([known[a:b].std(axis=0) for a, b in halves], axis=0) if halves else 0.0
    for k in np.flatnonzero(np.ptp(means, axis=0) > 1.5 * scatter) if halves else ():
        out[:, k] = np.interp(np.arange(len(values)), [0.5 * (a + b) for a, b in halves], means[:, k])
    return out


def _empty_frames(vertical: NDArray[np.float64], rate: float) -> NDArray[np.bool_] | None:
    """Empty plate's frames (n,): flat ones near zero or a range end; None without."""
    known = vertical[np.isfinite(vertical)]
    if len(known) < 3:
        return None
    peak = float(np.percentile(np.abs(known), 99.5))
    window = max(_WINDOW * peak, min(_WINDOW_N, 0.3 * peak))
    near = known[np.abs(known) <= window]
    if len(near) >= max(3.0, _FEWEST * len(known)) and window > 0.0:
        level, width = _level(near, window, 0.0, peak)
    else:
        middle = 0.5 * float(known.max() + known.min())
        half = 0.5 * float(np.ptp(known))
        if not half > 0.0:
            return None
        level, width = _level(known, half, middle, 2.0 * half)
        beside = max(float((known > level - width).mean()), float((known < level + width).mean()))
        if beside < _ONE_SIDE or abs(level - middle) < 0.5 * half or width > _FLAT * half:
            return None
    wide = max(width, _FAR * float(np.ptp(known)))
    flat = np.abs(np.nan_to_num(vertical, nan=np.inf) - level) <= wide
    block = max(2, round(0.5 * _SHORTEST * rate))
    whole = np.pad(vertical, (0, -len(vertical) % block), constant_values=np.nan).reshape(-1, block)
    noise = 1.4826 * float(np.median(np.abs(np.diff(known, 2)))) / np.sqrt(6.0)
    still = np.fmax.reduce(whole, axis=1) - np.fmin.reduce(whole, axis=1) <= 2.0 * _NOISES * noise + width
    flat &= np.repeat(still, block)[: len(vertical)]
    empty = np.zeros(len(vertical), dtype=bool)
    for a, b in true_runs(flat):
        if b - a >= max(2, round(_SHORTEST * rate)):
            edge = min((b - a) // 5, round(0.05 * rate))  # the ends belong to a foot that lands or leaves
            empty[a + edge : b - edge] = True
    return empty if empty.sum() >= max(2.0, _FEWEST * len(known)) else None


def _level(values: NDArray[np.float64], reach: float, about: float, peak: float) -> tuple[float, float]:
    counts, edges = np.histogram(values, bins=60, range=(about - reach, about + reach))
    smooth = np.convolve(counts, [1, 2, 1], mode="same")
    level = 0.5 * float(edges[np.argmax(smooth)] + edges[np.argmax(smooth) + 1])
    width = reach / 10.0
    for _ in range(3):
        part = values[np.abs(values - level) <= width]
        level = float(np.median(part))
        width = max(_NOISES * 1.4826 * float(np.median(np.abs(part - level))), 2e-3 * peak, 1e-9)
    return level, width


def _refuse_no_foot(plate: Plate) -> None:
    size = np.linalg.norm(np.nan_to_num(plate.force), axis=1)
    loaded = size > max(LEAST, 0.2 * float(np.percentile(size, 99.5)))
    if not loaded.any() or not np.isfinite(plate.force[loaded][:, :2]).any():
        return
    across = np.hypot(*np.nan_to_num(plate.force[loaded, :2]).T)
    share = float(np.median(across / np.maximum(np.abs(plate.force[loaded, 2]), 1e-9)))
    if share > _SHEAR:
        raise FormatError(
            f"the horizontal force of {plate.name} is {share:.2g} of its vertical one: no foot pushes so (a handrail, "
            "a wheel's rim, or another vertical axis?); allowed: force plates under feet"
        )


def _doubt_run(plate: Plate, rate: float, warnings: list[str]) -> None:
    """Refuses or doubts one plate whose contacts are so close that both feet run on it."""
    contacts = plate_contacts(0, plate.force[:, 2], rate, _CHATTER)
    gaps = [after.begin - before.end for before, after in itertools.pairwise(contacts)]
    usual = float(np.median(gaps)) / rate if len(gaps) > 1 else _SWING
    if usual >= _SWING:
        return
    text = f"{plate.name} is empty for {usual:.2g} s between contacts, which is the flight of a run and no foot's swing"
    if usual < _BRIEF:
        raise FormatError(f"{text}: both feet run, or hop, on one plate, which does not separate them; {_A_PLATE_EACH}")
    warnings.append(f"{text}: where both feet run on it, strides are steps here")


def _doubt_one_foot(plate: Plate, markers: Mapping[Side, NDArray[np.float64]], warnings: list[str]) -> None:
    """Warns where the markers of both feet are over a loaded plate in most frames, as in standing."""
    if plate.corners is None or len(markers) < 2:
        return
    loaded = np.nan_to_num(plate.force[:, 2]) > max(LEAST, 0.2 * float(np.nanmax(plate.force[:, 2])))
    over = np.array(
        [_from_edge(plate.corners, np.nan_to_num(track[loaded], nan=1e9)) > 0.0 for track in markers.values()]
    )
    if over.all(axis=0).mean() > 0.5:
        warnings.append(
            f"the markers of both feet are over {plate.name} while it is loaded: its load is that of both feet, though "
            "it is shown as one foot's"
        )


def on_its_surface(plate: Plate, warnings: list[str]) -> Plate:
    """Returns a plate with centre of pressure on its surface and free moment about its normal; adds to `warnings`."""
    vertical = np.where(plate.force[:, 2] > LEAST, plate.force[:, 2], np.nan)
    cop = plate.cop
    free = plate.free
    if plate.moment is not None:
        # With r in the surface and M = r x F + f n: n x M = r (n . F) and M . F = f (n . F).
        n = plate.normal
        moment = np.column_stack([plate.moment[:, :2], np.nan_to_num(plate.moment[:, 2])])
        pressing = np.nan_to_num(plate.force[:, :2]) @ n[:2] + n[2] * vertical
        free = (plate.moment * plate.force).sum(axis=1) / pressing
        cop = np.cross(n, moment)[:, :2] / pressing[:, None] + plate.origin
    if cop is None:
        return plate
    cop = np.where(np.isfinite(vertical)[:, None] & np.isfinite(cop), cop, np.nan)
    known = cop[np.isfinite(cop).all(axis=1) & (plate.force[:, 2] > 0.2 * np.nanmax(plate.force[:, 2]))]
    if plate.corners is not None and len(known):
        inside = _from_edge(plate.corners, known)
        outside = float((inside < -_EDGE).mean())
        if outside <= _OUTSIDE and (inside < _BRINK).any():
            warnings.append(
                f"the centre of pressure of {plate.name} comes within {1e3 * _BRINK:g} mm of its edge: where a part of "
                "a foot is off the plate, forces and contact times are too small"
            )
        elif outside > _OUTSIDE:
            warnings.append(
                f"the centre of pressure of {plate.name} lies outside its corners in {100.0 * outside:.0f} % of its "
                "loaded frames: check corners, origin and channels; forces do not depend on them"
            )
    return replace(plate, cop=cop, free=free)


def _from_edge(corners: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    # Below 0 outside.
    edges = np.roll(corners, -1, axis=0) - corners
    away = points[:, None] - corners
    turns = (edges[:, 0] * away[..., 1] - edges[:, 1] * away[..., 0]) / np.maximum(np.linalg.norm(edges, axis=1), 1e-9)
    return np.asarray((turns * np.sign(np.cross(np.append(edges[0], 0.0), np.append(edges[1], 0.0))[2])).min(axis=1))


def _is_of_both(plate: Plate, contact: PlateContact) -> bool:
    if plate.cop is None:
        return False
    span = slice(contact.begin, contact.end)
    load = np.nan_to_num(plate.force[span, 2])
    points = plate.cop[span][load > 0.1 * load.max(initial=0.0)]
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) < 10:
        return False
    _, axes = np.linalg.eigh(np.cov(points.T))
    low, high = np.percentile(points @ axes, (2.0, 98.0), axis=0)
    width, length = np.sort(high - low)
    return bool(length > _FOOT[0] or width > _FOOT[1])


def _weights(
    plates: Sequence[Plate], contacts: Sequence[PlateContact], sides: Sequence[Side | None], reach: int
) -> dict[Side, list[NDArray[np.bool_]]]:
    n = len(plates[0].force)
    out: dict[Side, list[NDArray[np.bool_]]] = {side: [np.zeros(n, dtype=bool) for _ in plates] for side in SIDES}
    for i, plate in enumerate(plates):
        own = [(c, s) for c, s in zip(contacts, sides, strict=True) if c.plate == i]
        if not own:
            out[plate.side or "left"][i][:] = True
        elif len(feet := {s for _, s in own}) == 1 and (foot := feet.pop()) and sides.count(foot) == len(own):
            out[foot][i][:] = True  # whole, with its noise between and around the contacts
            continue
        for k, (contact, side) in enumerate(own):
            if side is None:
                continue
            begin = max(contact.begin - reach, 0 if k == 0 else (own[k - 1][0].end + contact.begin) // 2)
            end = min(contact.end + reach, n if k == len(own) - 1 else (contact.end + own[k + 1][0].begin) // 2)
            out[side][i][begin:end] = True
    return {side: masks for side, masks in out.items() if any(m.any() for m in masks)}


def _foot(side: Side, plates: Sequence[Plate], masks: Sequence[NDArray[np.bool_]]) -> FootRecording:
    known = [p for p, mask in zip(plates, masks, strict=True) if mask.any()]
    own = [mask for mask in masks if mask.any()]
    force = np.sum([np.where(m[:, None], np.nan_to_num(p.force), 0.0) for p, m in zip(known, own, strict=True)], axis=0)
    lost = np.logical_or.reduce([m & ~np.isfinite(p.force[:, 2]) for p, m in zip(known, own, strict=True)])
    force[lost] = np.nan
    if any(p.cop is None for p in known):
        return FootRecording(side, force[:, 2:3], None, total=force[:, 2])
    load = np.array(
        [np.where(m & np.isfinite(p.cop[:, 0]), p.force[:, 2], 0.0) for p, m in zip(known, own, strict=True)]  # type: ignore[index]
    )
    places = np.array([np.nan_to_num(p.cop) for p in known])  # type: ignore[arg-type]
    with np.errstate(invalid="ignore", divide="ignore"):
        cop = (load[:, :, None] * places).sum(axis=0) / load.sum(axis=0)[:, None]
    if not all(np.isfinite(p.force[:, :2]).any() for p in known):
        return FootRecording(side, force[:, 2:3], None, total=force[:, 2], cop=cop)
    free = np.sum(
        [np.where(m, np.nan_to_num(p.free), 0.0) for p, m in zip(known, own, strict=True) if p.free is not None]
        or [np.zeros(len(force))],
        axis=0,
    )
    x, y = np.nan_to_num(cop).T
    moment = np.column_stack([y * force[:, 2], -x * force[:, 2], x * force[:, 1] - y * force[:, 0] + free])
    return FootRecording(side, force[:, 2:3], None, total=force[:, 2], cop=cop, wrench=np.column_stack([force, moment]))
