"""Recordings of force plates drawn by a seed, with the walk in them: plates of types 1 to 5, and split belts."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

KINDS = ("type 1", "type 2", "type 3", "type 4", "type 5", "split belt")
UNITS = ((1.0, "N", 1e3, "Nmm"), (1.0, "N", 1.0, "Nm"), (1.0, "Newtons", 1e3, "N.mm"), (1e-3, "kN", 1.0, "N.m"))
POINTS = ((1e3, "mm"), (1.0, "m"), (1e2, "cm"))


@dataclass
class Contact:
    """Force on the foot (n, 3) in N, CoP (n, 2) in m, free moment (n,) in N m of a contact; x ahead, y left, z up."""

    side: str
    begin: float
    end: float
    force: np.ndarray
    cop: np.ndarray
    free: np.ndarray


@dataclass
class Laboratory:
    """A file and what is true of it."""

    kind: str
    rate: float
    time: np.ndarray
    plates: list[list[Contact]]
    period: float = 0.0
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    "Rotation (3, 3) from the walk's axes to the laboratory's."
    trouble: str = ""
    text: str = ""

    @property
    def contacts(self) -> list[Contact]:
        return sorted((c for own in self.plates for c in own), key=lambda c: c.begin)


def made_contact(random, time, side, begin, last, place, top):
    share = np.clip((time - begin) / last, 0.0, 1.0)
    humps = np.sin(np.pi * share) + random.uniform(0.15, 0.3) * np.sin(3.0 * np.pi * share)
    up = np.where((share > 0.0) & (share < 1.0), top * humps / humps.max(), 0.0)
    inward = (-1.0 if side == "left" else 1.0) * random.uniform(0.03, 0.06)
    ahead = random.uniform(0.2, 0.35) * (share - 0.5)
    cop = np.column_stack([place[0] - 0.1 + 0.2 * share, np.full_like(share, place[1])])
    return Contact(side, begin, begin + last, np.column_stack([ahead * up, inward * up, up]), cop, 0.003 * up)


TROUBLES = (
    "",
    "large offset",
    "drift",
    "no corners",
    "no units",
    "origin above",
    "lost frames",
    "both feet on one plate",
)


def made_laboratory(seed: int, hard: bool = False) -> tuple[Laboratory, np.random.Generator]:
    """The walk of a seed over plates of the kind that the seed has."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    rate = float(random.choice([100.0, 200.0, 500.0, 1000.0]))
    trouble = TROUBLES[int(random.integers(len(TROUBLES)))] if hard else ""
    top, last = random.uniform(450.0, 1300.0), random.uniform(0.55, 0.85)
    first = str(random.choice(["left", "right"]))
    sides = [first, "left" if first == "right" else "right"]
    width = random.uniform(0.06, 0.14)
    if kind == "split belt":
        period = last / random.uniform(0.6, 0.66)
        time = np.arange(0.0, 12.0, 1.0 / rate)
        plates = []
        for k, side in enumerate(sides):
            place = np.array([0.0, width if side == "left" else -width])
            begins = np.arange(0.3 + 0.5 * k * period, 11.5 - last, period)
            contacts = [made_contact(random, time, side, b, last, place, top) for b in begins]
            for c in contacts:
                c.cop[:, 0] *= -1.0  # the belt carries the foot backwards
            plates.append(contacts)
        if random.random() < 0.5:
            plates.reverse()
        return Laboratory(kind, rate, time, plates, period, trouble=trouble), random
    time = np.arange(0.0, 3.5, 1.0 / rate)
    count = int(random.integers(1, 4))
    plates = []
    for k in range(count):
        side = sides[k % 2]
        place = np.array([0.3 + 0.65 * k, width if side == "left" else -width])
        plates.append([made_contact(random, time, side, 0.5 + 0.55 * last * 1.6 * k, last, place, top)])
    if trouble == "both feet on one plate" and count > 1:
        plates = [[*plates[0], *plates[1]], *plates[2:]]
        for contact in plates[0]:
            contact.cop[:, 0] += plates[0][0].cop[0, 0] - contact.cop[0, 0]
    return Laboratory(kind, rate, time, plates, trouble=trouble), random


def _channels(kind: int, force: np.ndarray, away: np.ndarray, moment: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Channels (c, n) in N, m, N m of a plate, and its ORIGIN in m; force, place and moment (n, 3) in its own axes."""
    if kind == 1:
        return np.column_stack([force, away[:, :2], moment[:, 2] - np.cross(away, force)[:, 2]]).T, np.zeros(3)
    if kind in (3, 5):
        a, b, depth = 0.12, 0.2, -0.05
        below = moment - np.cross(force, [0.0, 0.0, depth])  # about the plane of the transducers
        fz = force[:, 2] / 4.0
        along, across, turn = below[:, 0] / (4.0 * b), below[:, 1] / (4.0 * a), below[:, 2] / (2.0 * b)
        four = [fz + along - across, fz + along + across, fz - along + across, fz - along - across]
        fx, fy = force[:, 0] / 2.0, force[:, 1] / 2.0
        return np.array([fx - turn, fx + turn, fy, fy, *four]), np.array([a, b, depth])
    offset = np.array([0.001, -0.002, -0.04])
    return np.column_stack([force, moment - np.cross(force, offset)]).T, offset


def write_c3d(path: Path, lab: Laboratory, random: np.random.Generator, shown: str | None = None) -> None:
    """Write the file, with axes, corners, offsets, units, signs and, where it is None, what it shows besides drawn."""
    import ezc3d

    number = 2 if lab.kind == "split belt" else int(lab.kind[-1])
    heading = random.choice([0.0, 90.0, 180.0, 270.0]) if lab.kind == "split belt" else random.uniform(0.0, 360.0)
    axes = [[0, 1, 2], [1, 2, 0], [2, 0, 1]][int(random.integers(3))]  # where x, y and z of the floor lie
    c, s = np.cos(np.radians(heading)), np.sin(np.radians(heading))
    floor = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    lab.turn = np.eye(3)[:, axes] @ floor
    factor, force_unit, turn_factor, moment_unit = UNITS[int(random.integers(len(UNITS)))]
    scale, length_unit = POINTS[int(random.integers(len(POINTS)))]
    down, on_plate = bool(random.random() < 0.7), bool(random.random() < 0.7)
    drawn = str(random.choice(["markers", "events", "nothing"]))
    shown = drawn if shown is None else shown
    n = len(lab.time)
    every, corners, origins, matrices = [], [], [], []
    spin = int(random.integers(4))
    largest = random.uniform(0.0, 50.0)
    for own in lab.plates:
        if lab.kind == "split belt":
            centre, half = np.array([0.0, np.mean([k.cop[:, 1].mean() for k in own])]), (0.9, 0.055)
        else:
            centre, half = own[0].cop.mean(axis=0), (0.3, 0.25)
        force = sum(k.force for k in own)
        centre = np.append(centre, 0.0)
        moment = sum(
            np.cross(np.column_stack([k.cop, np.zeros(n)]) - centre, k.force) + np.outer(k.free, [0.0, 0.0, 1.0])
            for k in own
        )
        loads = np.array([k.force[:, 2] for k in own])
        with np.errstate(invalid="ignore", divide="ignore"):
            place = np.nan_to_num(
                (loads[:, :, None] * np.array([k.cop for k in own])).sum(axis=0) / loads.sum(axis=0)[:, None]
            )
        away = np.column_stack([place - centre[:2] * (loads.sum(axis=0) > 0.0)[:, None], np.zeros(n)])
        quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        local = np.linalg.matrix_power(quarter, spin) @ np.diag([1.0, -1.0, -1.0] if down else [1.0, 1.0, 1.0])
        sign = -1.0 if on_plate else 1.0
        values, origin = _channels(number, sign * force @ local, away @ local, sign * moment @ local)
        noise = random.normal(0.0, 0.5, values.shape)
        noise[2 if number < 3 or number == 4 else slice(4, 8)] += largest if number not in (3, 5) else largest / 4.0
        if number == 1:
            noise[3:5] *= 1e-4
            noise[5] *= 0.05
            values[2] += noise[2]
            noise[2] = 0.0
        elif number in (2, 4):
            noise[3:] *= 0.05
        if lab.trouble in ("large offset", "drift"):
            load = random.uniform(60.0, 150.0) * np.ones(n)
            if lab.trouble == "drift":
                load = random.uniform(5.0, 30.0) * lab.time / lab.time[-1]
            noise[2 if number not in (3, 5) else slice(4, 8)] += load if number not in (3, 5) else load / 4.0
        values = values + noise
        if lab.trouble == "lost frames":
            begin = int(random.integers(0, n - n // 20))
            values[:, begin : begin + n // 50] = np.nan
        reach = np.array([[half[0], half[1]], [-half[0], half[1]], [-half[0], -half[1]], [half[0], -half[1]]])
        if spin % 2:
            reach = np.array([[half[1], half[0]], [-half[1], half[0]], [-half[1], -half[0]], [half[1], -half[0]]])
        ring = np.column_stack([reach, np.zeros(4)]) @ local.T + centre  # +x +y, -x +y, -x -y, +x -y of the plate
        corners.append(scale * (ring @ lab.turn.T).T)
        origins.append(scale * origin)
        if number in (4, 5):  # a matrix makes N and N of length of volts
            if number == 5:
                a, b, depth = origin
                to_load = np.array(
                    [
                        [1, 1, 0, 0, 0, 0, 0, 0],
                        [0, 0, 1, 1, 0, 0, 0, 0],
                        [0, 0, 0, 0, 1, 1, 1, 1],
                        [0, 0, depth, depth, b, b, -b, -b],
                        [-depth, -depth, 0, 0, -a, a, a, -a],
                        [-b, b, a, -a, 0, 0, 0, 0],
                    ],
                    dtype=float,
                )
                origins[-1] = np.zeros(3)
            else:
                to_load = np.eye(6)
            gains = random.uniform(50.0, 500.0, len(values))
            matrices.append(np.diag([1.0, 1.0, 1.0, scale, scale, scale]) @ to_load @ np.diag(gains))
            values = values / gains[:, None]
        elif number == 1:
            values = np.vstack([values[:3] * factor, values[3:5] * scale, values[5:] * turn_factor])
        elif number == 2:
            values = np.vstack([values[:3] * factor, values[3:] * turn_factor])
        else:
            values = values * factor
        every.append(values)
    if lab.trouble == "no corners":
        corners = [0.0 * k for k in corners]
    if lab.trouble == "origin above":
        origins = [-k if number in (2, 4) else k for k in origins]
    count, wide = len(every), len(every[0])
    units = {1: [force_unit] * 3 + [length_unit] * 2 + [moment_unit], 3: [force_unit] * 8}.get(
        number, [force_unit] * 3 + [moment_unit] * 3
    )
    units = ["V"] * wide if number in (4, 5) else units
    units = [""] * wide if lab.trouble == "no units" else units
    file = ezc3d.c3d()
    parameters = file["parameters"]
    point, analog, plates = (parameters[k] for k in ("POINT", "ANALOG", "FORCE_PLATFORM"))
    tracks = {f"{side[0].upper()}{m}": side for side in ("left", "right") for m in ("HEE", "TOE")}
    names = list(tracks) if shown == "markers" else ["C7"]
    per = 5 if lab.rate % 5 == 0 and n % 5 == 0 else 1
    points = np.zeros((4, len(names), n // per))
    for i, name in enumerate(names):
        at = np.array([0.0, 0.0, 1.4])
        if name in tracks:
            own = [k for k in lab.contacts if k.side == tracks[name]]
            track = np.zeros((n, 3))
            if own:
                begins = [k.begin for k in own]
                nearest = np.clip(np.searchsorted(begins, lab.time) - 1, 0, len(own) - 1)
                track[:, :2] = np.array([k.cop.mean(axis=0) for k in own])[nearest]
            else:
                track[:, 1] = 0.3 if tracks[name] == "left" else -0.3
            track[:, 2] = 0.05
            points[:3, i] = scale * (track @ lab.turn.T)[::per].T[:, : n // per]
        else:
            points[:3, i] = (scale * lab.turn @ at)[:, None]
    point["RATE"]["value"], point["UNITS"]["value"], point["LABELS"]["value"] = [lab.rate / per], [length_unit], names
    analog["RATE"]["value"], analog["LABELS"]["value"] = [lab.rate], [f"ch{i}" for i in range(count * wide)]
    analog["UNITS"]["value"], analog["SCALE"]["value"] = units * count, [1.0] * (count * wide)
    analog["OFFSET"]["value"] = [0] * (count * wide)
    for name, value in (
        ("USED", np.array([count])),
        ("TYPE", np.full(count, number)),
        ("ZERO", np.array([1, 0])),
        ("CORNERS", np.stack(corners, axis=2)),
        ("ORIGIN", np.stack(origins, axis=1)),
        ("CHANNEL", np.arange(1, count * wide + 1).reshape(count, wide).T),
    ):
        plates[name]["value"] = value
    if matrices:
        file.add_parameter("FORCE_PLATFORM", "CAL_MATRIX", np.stack(matrices, axis=2))
    file["data"]["points"], file["data"]["analogs"] = points, np.concatenate(every)[None]
    if shown == "events":
        stated = [
            (f"Foot {w}", k.side.capitalize(), t)
            for k in lab.contacts
            for w, t in (("Strike", k.begin), ("Off", k.end))
        ]
        file.add_parameter("EVENT", "LABELS", [e[0] for e in stated])
        file.add_parameter("EVENT", "CONTEXTS", [e[1] for e in stated])
        file.add_parameter("EVENT", "TIMES", np.array([[0.0] * len(stated), [e[2] for e in stated]]))
    lab.text = (
        f"{lab.kind}, {count} plates, {lab.rate:g} Hz, {heading:.0f} deg, axes {axes}, {force_unit} {moment_unit} "
        f"{length_unit}, {'down' if down else 'up'}, on {'plate' if on_plate else 'foot'}, spin {spin}, "
        f"{largest:.0f} N, {shown}, {lab.trouble}"
    )
    file.write(str(path))
