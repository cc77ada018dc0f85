"""A table whose meaning is changed is right, refused, or there is a note that was not there before."""

import pytest

from plantar.errors import PlantarError
from plantar.gait.analysis.analyse import analyse

from .changed_meaning import CHANGES
from .taken_away import KINDS, made
from .test_taken_away import wrong

CASES = [(kind, name) for kind in range(len(KINDS)) for name in CHANGES]


def verdict(kind: int, name: str, folder) -> str:
    """How a changed table of a kind ends: right, refused, or with a new note; else what is wrong and unsaid."""
    import numpy as np

    table = made(kind)
    whole = folder / "whole.csv"
    whole.write_text(table.text())
    before = {w[:25] for w in analyse(whole).metrics["warnings"]}
    path = folder / "walk.csv"
    path.write_bytes(CHANGES[name](table, np.random.default_rng(kind)))
    try:
        walk = analyse(path)
    except PlantarError:
        return "refused"
    what = wrong(walk, table)
    if not what:
        return "right"
    new = [w for w in walk.metrics["warnings"] if w[:25] not in before]
    return "noted" if new else what


@pytest.mark.sample(8)
@pytest.mark.parametrize(("kind", "name"), CASES)
def test_a_changed_table_is_right_refused_or_noted(kind, name, tmp_path):
    assert verdict(kind, name, tmp_path) in ("right", "refused", "noted")
