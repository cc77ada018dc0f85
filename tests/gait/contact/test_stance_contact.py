import math
from dataclasses import replace

import numpy as np
import pytest

from plantar import hex_layout
from plantar.errors import InputError
from plantar.gait.contact.stance_contact import ContactSettings, StanceContact
from plantar.geometry.polygon import area, centroid, signed_margin
from plantar.sensing.partial_contact import PartialContact
from plantar.sensing.reading import Reading

SOLE = hex_layout([[-0.125, -0.075], [0.125, -0.075], [0.125, 0.075], [-0.125, 0.075]], clip=False)
FIT = PartialContact(SOLE)
REAR = np.array([[1.0, 0.0, 0.0]])  # the ground ends under the sole's middle
WHOLE = np.empty((0, 3))


class Foot:
    """A sole that comes down on ground with given edges and takes the weight over."""

    def __init__(self, lines: np.ndarray, seed: int = 0, **settings: object) -> None:
        self.contact = StanceContact(SOLE, ContactSettings(**settings))
        self.rng = np.random.default_rng(seed)
        self.lines, self.time = lines, 0.0

    def descend(self, readings: int = 12, noise: float = 0.002) -> None:
        over = (SOLE.positions[:, :2] @ self.lines[:, :2].T < self.lines[:, 2]).all(axis=1)
        for k in range(readings):
            self.time += 0.004
            height = 0.03 - 0.002 * k
            distance = np.where(over, height, math.inf) + self.rng.normal(0.0, noise, len(SOLE))
            self.contact.update_view(Reading(self.time, np.zeros(len(SOLE)), distance))

    def load(self, readings: int = 30, force: float = 300.0, at: tuple[float, float] | None = None) -> bool:
        changed = False
        centre = at if at is not None else (-0.06, 0.0) if len(self.lines) else (0.0, 0.0)
        for _ in range(readings):
            self.time += 0.004
            forces = FIT.expected(force, centre, self.lines) + self.rng.normal(0.0, 1.47, len(SOLE))
            changed |= self.contact.update(Reading(self.time, np.clip(forces, 0.0, None)), force)
        return changed


@pytest.mark.parametrize("seed", range(5))
def test_whole_ground_is_the_whole_sole(seed):
    for sees in (True, False):
        foot = Foot(WHOLE, seed)
        if sees:
            foot.descend()
        foot.load()
        assert foot.contact.settled
        assert foot.contact.whole
        assert foot.contact.area_ratio == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_an_edge_under_the_sole_is_seen_before_it_is_felt(seed):
    foot = Foot(REAR, seed)
    foot.descend()
    assert not foot.contact.settled
    assert foot.load(readings=3)  # within three readings of touchdown
    assert foot.contact.settled
    assert foot.contact.area_ratio == pytest.approx(0.5, abs=0.06)
    assert foot.contact.center_in_sole == pytest.approx([-0.0565, 0.0], abs=0.008)


@pytest.mark.parametrize("seed", range(5))
def test_forces_alone_find_the_edge_too(seed):
    foot = Foot(REAR, seed)
    foot.load(readings=60, force=600.0, at=(-0.03, 0.0))
    assert foot.contact.area_ratio == pytest.approx(0.5, abs=0.12)
    assert foot.contact.center_in_sole == pytest.approx([-0.0565, 0.0], abs=0.015)


def test_a_load_on_the_heel_is_no_missing_ground():
    foot = Foot(WHOLE)
    foot.load(at=(-0.1, 0.0))
    assert foot.contact.whole


def test_the_foothold_does_not_shrink_when_the_load_moves_away():
    foot = Foot(WHOLE)
    foot.load()
    foot.load(at=(-0.08, 0.0), force=800.0)
    foot.load(at=(0.08, 0.0), force=800.0)
    assert foot.contact.whole


@pytest.mark.parametrize("period", [0.001, 0.002, 0.004])
def test_a_sole_that_is_read_oftener_settles_no_sooner(period):
    contact = StanceContact(SOLE, ContactSettings())
    forces = FIT.expected(300.0, (-0.06, 0.0), WHOLE)
    times = [period * (k + 1) for k in range(40)]
    settled = next(time for time in times if contact.update(Reading(time, forces), 300.0))
    assert settled - times[0] == pytest.approx(0.008, abs=0.0021)  # the third reading of 4 ms


def test_a_touch_that_jumps_from_place_to_place_is_no_missing_ground():
    rng = np.random.default_rng(0)
    for _ in range(100):
        contact = StanceContact(SOLE, ContactSettings())
        touches = [
            (load, FIT.expected(load, place, WHOLE))
            for load, place in zip(
                rng.uniform(95, 250, 3), rng.uniform((-0.12, -0.07), (0.12, 0.07), (3, 2)), strict=True
            )
        ]
        for k in range(40):
            load, forces = touches[min(k, 2)]
            contact.update(Reading(0.004 * (k + 1), forces), load)
            assert contact.whole


def test_lifting_off_forgets():
    foot = Foot(REAR)
    foot.descend()
    foot.load()
    foot.contact.lift()
    assert foot.contact.whole
    assert not foot.contact.settled
    foot.lines = WHOLE
    foot.descend()
    foot.load(at=(0.0, 0.0))
    assert foot.contact.whole


def test_without_load_nothing_settles_and_a_reading_counts_once():
    foot = Foot(REAR)
    foot.load(force=20.0)
    assert not foot.contact.settled
    reading = Reading(9.0, np.full(len(SOLE), 20.0))
    assert [foot.contact.update(reading, 800.0) for _ in range(5)] == [False] * 5


def test_dead_taxels_neither_see_nor_feel():
    foot = Foot(REAR)
    over = SOLE.positions[:, 0] < 0.0
    distance = np.where(over, 0.01, math.inf)
    distance[::7] = math.nan
    for k in range(8):
        foot.contact.update_view(Reading(0.004 * (k + 1), np.zeros(len(SOLE)), distance))
    forces = FIT.expected(400.0, (-0.06, 0.0), REAR)
    forces[::7] = math.nan
    for k in range(10):
        foot.contact.update(Reading(1.0 + 0.004 * k, forces), 400.0)
    assert foot.contact.area_ratio == pytest.approx(0.5, abs=0.08)


def test_bad_settings_are_refused():
    with pytest.raises(InputError, match="model_error"):
        ContactSettings(model_error=-1.0)


def test_a_foothold_is_foreseen_where_the_sole_will_land():
    foot = Foot(REAR)
    assert foot.contact.foresee(np.zeros(2)) is None
    foot.descend()
    here, further = foot.contact.foresee(np.zeros(2)), foot.contact.foresee(np.array([0.014, 0.0]))
    assert further is not None
    assert centroid(here) == pytest.approx([-0.0565, 0.0], abs=0.008)
    moved = centroid(further)[0] - centroid(here)[0]
    assert moved == pytest.approx(-0.007, abs=1e-3)  # the edge stays, the sole goes on over it
    whole = Foot(WHOLE)
    whole.descend()
    assert whole.contact.foresee(np.zeros(2)) is None


def on_its_edge(foot: Foot, rise: float, readings: int = 40) -> None:
    """A sole that rests on the edge of the rear ground, whose rows beside it carry nothing; it rises by a slope along
    -x, towards that ground."""
    row = np.abs(SOLE.positions[:, 0] + 0.01) < 0.012
    for _ in range(readings):
        foot.time += 0.004
        forces = np.where(row, 300.0 / row.sum(), 0.0) + foot.rng.normal(0.0, 1.47, len(SOLE))
        slope = np.array([-rise, 0.0])
        foot.contact.update(Reading(foot.time, np.clip(forces, 0.0, None)), 300.0, slope)


@pytest.mark.parametrize("seed", range(3))
def test_a_sole_on_its_edge_has_its_ground_where_it_rises(seed):
    turned, level = Foot(REAR, seed), Foot(REAR, seed)
    on_its_edge(turned, 0.0025)
    on_its_edge(level, 0.0)
    assert level.contact.area_ratio < 0.3  # a level sole would carry on both sides of the row, and does not
    assert 0.35 < turned.contact.area_ratio < 0.65
    assert turned.contact.center_in_sole[0] < -0.04


STRIP = np.array([[1.0, 0.0, 0.03], [-1.0, 0.0, 0.03]])  # 60 mm of ground across the sole


def on_its_rear_edge(foot: Foot, readings: int = 20) -> None:
    """A sole that rests on the rear edge of a strip: one row carries, and the strip goes on ahead of it."""
    row = np.abs(SOLE.positions[:, 0] + 0.03) < 0.013
    for _ in range(readings):
        foot.time += 0.004
        forces = np.where(row, 200.0 / row.sum(), 0.0) + foot.rng.normal(0.0, 1.47, len(SOLE))
        foot.contact.update(Reading(foot.time, np.clip(forces, 0.0, None)), 200.0)


@pytest.mark.parametrize("seed", range(3))
def test_one_edge_of_a_strip_that_is_remembered_is_enough(seed):
    told, untold = Foot(STRIP, seed), Foot(STRIP, seed)
    told.contact.expect(STRIP)
    for foot in (told, untold):
        on_its_rear_edge(foot)
    assert told.contact.center_in_sole == pytest.approx([0.0, 0.0], abs=0.004)
    assert told.contact.area_ratio == pytest.approx(area(FIT.polygon(STRIP)) / area(FIT.polygon(WHOLE)), abs=0.02)
    assert abs(untold.contact.center_in_sole[0]) > 0.025  # a row, or all that lies ahead of it


def test_loads_beyond_a_line_deny_it():
    foot = Foot(WHOLE)
    foot.contact.expect(STRIP)
    foot.load(at=(0.0, 0.0))
    assert foot.contact.whole


def test_silence_between_lines_denies_them():
    foot = Foot(REAR)
    foot.contact.expect(np.array([[1.0, 0.0, 0.07]]))
    foot.load(readings=90, force=600.0, at=(-0.03, 0.0))
    assert foot.contact.center_in_sole == pytest.approx([-0.0565, 0.0], abs=0.015)


@pytest.mark.parametrize("line", [[1.0, 0.0, 0.13], [1.0, 0.0, -0.12]])
def test_a_line_that_cuts_nothing_off_or_leaves_nothing_is_not_expected(line):
    foot = Foot(WHOLE)
    foot.contact.expect(np.array([line]))
    foot.load(readings=3, at=(0.0, 0.0))
    assert foot.contact.whole
    assert foot.contact.lines.shape == (0, 3)


def test_what_a_cover_carries_along_is_no_ground(monkeypatch):
    """A crosstalk of a tenth gives the row beside an edge more than the least force of a taxel that carries."""
    cells = len(SOLE)
    spread = 0.9 * np.eye(cells)
    for i, near in enumerate(SOLE.neighbours):
        spread[list(near), i] = 0.1 / len(near)
    strip = np.array([[1.0, 0.0, 0.028], [-1.0, 0.0, 0.028]])
    forces = spread @ FIT.expected(1200.0, (0.0, 0.0), strip)
    assert forces[FIT.cover(strip)[:, 0] == 0.0].max() > ContactSettings().least_force
    found = []
    for share in (ContactSettings.least_beside, 0.0):
        monkeypatch.setattr(ContactSettings, "least_beside", share)
        contact = StanceContact(SOLE, ContactSettings())
        for k in range(20):
            contact.update(Reading(0.004 * (k + 1), forces), 1200.0)
        found.append(contact.area_ratio)
    true = area(FIT.polygon(strip)) / area(FIT.polygon(WHOLE))
    assert abs(found[0] - true) < abs(found[1] - true)
    assert found[0] == pytest.approx(true, abs=0.1)


@pytest.mark.parametrize("seed", range(3))
def test_as_printed_the_contact_polygon_is_the_hull_of_the_active_cells(seed):
    """T 4.22, 4.24: of all cells that once exceeded the level of their noise and still carry, nothing fitted."""
    sole = replace(SOLE, noise={"force": 1.47})
    contact = StanceContact(sole, ContactSettings(fit=False, remember=False))
    rng = np.random.default_rng(seed)
    expected = FIT.expected(300.0, (-0.06, 0.0), REAR)
    for k in range(3):
        forces = np.clip(expected + rng.normal(0.0, 1.47, len(SOLE)), 0.0, None)
        contact.update(Reading(0.004 * (k + 1), forces), 300.0)
    loaded = expected > sole.contact_levels.cell + 6.0 * 1.47
    corners = np.concatenate([sole.cell_polygon(int(i)) for i in np.flatnonzero(loaded)])
    assert contact.settled
    assert min(signed_margin(contact.polygon_in_sole, corner) for corner in corners) > -1e-9
    known = {tuple(v) for v in sole.vertices[:, :2].round(9).tolist()}
    assert {tuple(v) for v in contact.polygon_in_sole.round(9).tolist()} <= known
    assert contact.lines.shape == (0, 3)
