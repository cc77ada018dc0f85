"""Files of force plates drawn by seeds: each is read right, refused in one line, or warned of."""

import numpy as np
import pytest

from plantar import FormatError
from plantar.gait.analysis.analyse import Analysis, analyse

from .made_plates import Contact, Laboratory, made_laboratory, write_c3d

pytest.importorskip("ezc3d", reason="ezc3d is not installed: pip install '.[formats]'")

_Z_UP = {0: [1, 2, 0], 1: [2, 0, 1], 2: [0, 1, 2]}
LONG = [pytest.param(seed, marks=pytest.mark.long) for seed in range(12, 112)]


def _matched(walk: Analysis, lab: Laboratory) -> list[tuple[object, Contact]]:
    """Each step that was found, with the contact that begins nearest to it."""
    steps = sorted((s for g in walk.feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)
    return [(s, min(lab.contacts, key=lambda c: abs(c.begin - s.heel_strike_s))) for s in steps]


def _check_forces(walk: Analysis, lab: Laboratory, sides: bool) -> None:
    for step, contact in _matched(walk, lab):
        assert step.side == contact.side or not sides
        assert step["peak_force_N"] == pytest.approx(contact.force[:, 2].max(), abs=8.0)
        assert step["impulse_Ns"] == pytest.approx(np.trapezoid(contact.force[:, 2], lab.time), rel=0.02)
        assert step.heel_strike_s == pytest.approx(contact.begin, abs=0.02)
        assert step.toe_off_s == pytest.approx(contact.end, abs=0.02)


def _check_places(walk: Analysis, lab: Laboratory) -> None:
    order = _Z_UP[int(np.argmax(np.abs(lab.turn[:, 2])))]
    for step, contact in _matched(walk, lab):
        foot = walk.feet[step.side].foot
        own = np.flatnonzero(contact.force[:, 2] > 200.0)
        cop = (np.column_stack([contact.cop, np.zeros(len(lab.time))]) @ lab.turn.T)[own][:, order][:, :2]
        assert float(np.nanmedian(np.abs(foot.cop[own] - cop).max(axis=1))) < 0.01
        shear = (contact.force @ lab.turn.T)[own][:, order][:, :2]
        assert float(np.nanmedian(np.abs(foot.wrench[own, :2] - shear).max(axis=1))) < 5.0
        free = foot.wrench[own, 5] - cop[:, 0] * foot.wrench[own, 1] + cop[:, 1] * foot.wrench[own, 0]
        assert float(np.nanmedian(np.abs(free - contact.free[own]))) < 2.0


@pytest.mark.sample(8)
@pytest.mark.parametrize("seed", [*range(12), *LONG])
@pytest.mark.parametrize("hard", [False, True])
def test_made_plates_are_right_refused_or_warned_of(tmp_path, seed, hard):
    lab, random = made_laboratory(seed, hard)
    path = tmp_path / "walk.c3d"
    write_c3d(path, lab, random)
    together = lab.trouble == "both feet on one plate" and len(lab.plates[0]) == 2
    if together and len(lab.plates) == 1:
        with pytest.raises(FormatError, match=r"both feet are on one plate [^\n]*\Z"):
            analyse(path)
        return
    walk = analyse(path)
    assert together == any("both feet are on one plate" in w for w in walk.warnings), lab.text
    assert ("no corners" in lab.trouble) == any("state no corners" in w for w in walk.warnings), lab.text
    found = len(_matched(walk, lab))
    if lab.trouble == "lost frames":
        assert len(lab.contacts) - 2 <= found <= len(lab.contacts)
    else:
        assert found == len(lab.contacts) - 2 * together, lab.text
    _check_forces(walk, lab, sides=lab.trouble != "no corners" and not together)
    if lab.trouble != "no corners":
        _check_places(walk, lab)
    if lab.kind == "split belt" and lab.trouble != "lost frames":
        gait, contact = walk.metrics["gait"], lab.contacts[0]
        assert gait["cadence_steps_per_min"] == pytest.approx(120.0 / lab.period, rel=0.003)
        both = 100.0 * (2.0 * (contact.end - contact.begin) / lab.period - 1.0)
        assert gait["double_support_percent"] == pytest.approx(both, abs=3.0)
