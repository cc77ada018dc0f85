"""Checks of a part of your own, one a kind: each returns what the part lacks, a sentence each, and nothing else.

    from plantar.testing.swing import check_swing
    assert check_swing(HighSwing()) == []

`swing`, `terrain`, `proposer`, `balance_law`, `recording_format`, `live_source` and `task` hold one function each. They
try a part as the toolkit uses it, at values that its author may not have thought of.
"""
