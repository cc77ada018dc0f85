"""A robot that leads has to have moved its partner by half its way; one that follows need not."""

from __future__ import annotations

from plantar.sim.judging.partner_truth import partner_reasons


def test_a_leader_moves_its_partner() -> None:
    assert partner_reasons("follower", 0.8, -0.41) == []
    (reason,) = partner_reasons("follower", 0.8, -0.39)
    assert (reason["criterion"], reason["value"], reason["limit"]) == ("led", 0.39, 0.4)
    assert partner_reasons("follower", 0.8, 0.5)
    assert partner_reasons("leader", 0.8, 0.5) == []
