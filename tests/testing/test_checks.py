"""The checks of parts take what is built in, and name what a broken part lacks."""

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from plantar import Reading, hex_layout
from plantar.errors import InputError
from plantar.formats import formats
from plantar.gait.balance.balance_laws import balance_laws
from plantar.gait.balance.dcm_balance import BalanceGains
from plantar.gait.balance.load_transfer import OpenLoop
from plantar.gait.feet.swing_flight import PolynomialSwing
from plantar.gait.feet.swing_kind import SwingKind
from plantar.gait.feet.swing_kinds import swing_kinds
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority
from plantar.live.source import LiveSource, LiveStream
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.machine import load_machine
from plantar.sim.terrain import Ground, Solid, Terrain, terrain_kinds
from plantar.testing.balance_law import check_balance_law
from plantar.testing.live_source import check_live_source
from plantar.testing.proposer import check_proposer
from plantar.testing.recording_format import check_format
from plantar.testing.swing import check_swing
from plantar.testing.task import check_task
from plantar.testing.terrain import check_terrain
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.task import Demand

SOLE = hex_layout([[-0.1, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.1, 0.05]])

COUNT = len(SOLE)


def test_built_in_swings_lack_nothing():
    for kind in swing_kinds().values():
        assert [text for text in check_swing(kind()) if "needs" not in text and "table" not in text] == []


class Jumping(SwingKind, table="jumping", needs={"control.swing_shape": ("jumping",)}):
    """Goes to its end at once."""

    def begin(self, start):
        swing = PolynomialSwing().begin(start)

        def at(time):
            place, yaw = swing.at(time)
            return (place if time < 0.5 * start.duration else np.array([*start.end[:2], place[2]])), yaw

        names = ("risen", "comes_down", "aimed", "duration")
        return SimpleNamespace(at=at, **{name: getattr(swing, name) for name in names})


def test_a_swing_that_jumps_is_named():
    assert any("jumps by" in text for text in check_swing(Jumping()))


@pytest.mark.parametrize("name", sorted(terrain_kinds()))
def test_built_in_grounds_lack_nothing(name):
    assert check_terrain(terrain_kinds()[name]()) == []


class Unseeded(Terrain):
    """Draws from a generator of its own."""

    def ground(self, feet, rng):
        height = float(np.random.default_rng().uniform(0.01, 0.02))
        return Ground((Solid("box", (1.0, 1.0, height), np.zeros(3)),), 0.0, self.friction)


class Endless(Terrain):
    """Holds no number."""

    def ground(self, feet, rng):
        return Ground((Solid("box", (1.0, 1.0, np.nan), np.zeros(3)),), 0.0, self.friction)


def test_grounds_that_cannot_be_are_named():
    assert any("two grounds of one seed differ" in text for text in check_terrain(Unseeded()))
    assert any("not finite" in text for text in check_terrain(Endless()))


def test_a_proposer_is_asked_and_its_changes_are_applied():
    moved = SimpleNamespace(priority=Priority.COMMAND, propose=lambda tick: None)
    assert check_proposer(moved) == []
    beyond = SimpleNamespace(priority=Priority.COMMAND, propose=lambda tick: PlanChange("far", 99, longer=0.1))
    assert "cannot be applied" in check_proposer(beyond)[0]
    wrong = SimpleNamespace(priority=3, propose=lambda tick: "forward")
    assert check_proposer(wrong)[0].startswith("priority is none of")
    assert "returns a str" in check_proposer(wrong)[1]


def test_a_format_is_tried_on_damage(tmp_path):
    file = tmp_path / "walk.asc"
    text = "MySole\n" + "\n".join(f"{0.02 * i:.2f} {100 + i}" for i in range(50))
    file.write_text(text)
    known = formats()["table"] if "table" in formats() else next(reversed(formats().values()))
    bad = replace(known, recognises=lambda head: True, read=lambda path, options: int(path.read_text()[:3]))
    with pytest.raises(ValueError, match="invalid literal"):
        check_format(bad, file)
    csv = tmp_path / "walk.csv"
    rows = [f"{0.01 * i:.2f},{400 + i},{400 - i}" for i in range(200)]
    csv.write_text("time_s,left_fz_N,right_fz_N\n" + "\n".join(rows) + "\n")
    blind = replace(known, read=lambda path, options: known.read(path, replace(options, rate_hz=None)))
    found = check_format(blind, csv)
    assert any("a stated rate" in text for text in found)
    assert not any("raises" in text for text in found)


def stream(times, count=COUNT):
    readings = (("left", Reading(time, np.zeros(count))) for time in times)
    return LiveStream({"left": SOLE}, readings)


def opened(times, count=COUNT):
    def start(address, layout):
        if address != "here":
            raise InputError("no such address")
        return stream(times, count)

    return LiveSource("made", "made", start)


def test_a_live_source_is_listened_to():
    assert check_live_source(opened([0.0, 0.1, 0.2]), "here", None) == []
    assert "do not rise" in check_live_source(opened([0.0, 0.1, 0.1]), "here", None)[0]
    assert "3 forces" in check_live_source(opened([0.0], 3), "here", None)[0]
    assert check_live_source(opened([]), "here", None) == ["no reading comes"]
    careless = LiveSource("made", "made", lambda address, layout: stream([0.0]))
    assert "an address that cannot be is opened" in check_live_source(careless, "here", None)[0]


def test_a_task_states_shapes_that_fit():
    machine = load_machine("planar-arm")
    model = machine.spec().compile()
    data = mujoco.MjData(model)
    robot = MujocoDynamics(model)
    robot.update(data.qpos, data.qvel, 0.0)
    assert check_task(Posture(machine.posture, 100.0), robot) == []
    row = np.zeros((1, len(robot.velocity)))
    both = SimpleNamespace(demand=lambda robot, skin: Demand(row, force=np.zeros(1), acceleration=np.zeros(1)))
    found = check_task(both, robot)
    assert any("give one of them" in text for text in found)
    short = SimpleNamespace(demand=lambda robot, skin: Demand(row[:, 1:], force=np.zeros(1)))
    assert "the Jacobian has shape" in check_task(short, robot)[0]


@pytest.mark.parametrize("name", sorted(balance_laws()))
def test_built_in_balance_laws_lack_nothing(name):
    assert check_balance_law(balance_laws()[name]()) == []


class Contrary(BalanceGains):
    """Moves the ZMP away from a DCM that is off, and carries half of the weight."""

    def law(self, omega, mass, period):
        law = super().law(omega, 0.5 * mass, period)
        plain = law.update

        def update(reference, dcm, *others):
            return plain(reference, 2.0 * reference.dcm - dcm, *others)

        law.update = update
        return law


def test_a_law_that_makes_errors_grow_is_named():
    lacks = check_balance_law(Contrary())
    assert any("against the DCM's error" in text for text in lacks)
    assert any("press with 294 N" in text for text in lacks)


class Still(BalanceGains):
    """Follows the plan, which no region bounds."""

    def law(self, omega, mass, period):
        return OpenLoop(mass)


def test_a_law_that_lets_errors_be_may_do_so():
    assert check_balance_law(Still()) == []
