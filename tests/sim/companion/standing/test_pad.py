"""What a contact's yield is measured against."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.sim.companion.standing.pad import PlannedContact

COMPLIANCE = 1e-3  # m/N
LAG = 0.1  # s in which the link follows its force


@pytest.mark.parametrize("before", [0.0, 0.012, -0.012])
def test_yield_is_the_contacts_own_whatever_the_contact_before_has_left(before):
    """The link is still `before` m from its rest, along the pad or against it, when it is touched."""
    link = SimpleNamespace(x=0.0)
    pad = SimpleNamespace(wanted=0.0, touching=lambda world: (np.array([link.x, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])))
    pose = np.array([0.2, -0.1, 1.0]), np.eye(3)
    world = SimpleNamespace(data=SimpleNamespace(time=0.0), pose=lambda name: pose)
    contact = PlannedContact(pad, begin=0.0, hold=1.5, force=10.0, against="base")
    contact.rest = contact.place(world)
    link.x = before
    for step in range(1, 1500):
        world.data.time = 0.001 * step
        force = pad.wanted
        contact.act(world.data.time, force)
        contact.judge(world, force)
        link.x += 0.001 / LAG * (COMPLIANCE * force - link.x)
    assert contact.measured == pytest.approx(10.0)
    assert contact.compliance == pytest.approx(1e3 * COMPLIANCE, rel=0.1)
