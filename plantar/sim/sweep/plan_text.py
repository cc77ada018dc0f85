"""What a sweep runs, from the command line's texts."""

from collections.abc import Sequence

from plantar.errors import InputError
from plantar.sim.sweep.limit_search import LimitSearch
from plantar.sim.sweep.plan import Sweep
from plantar.sim.sweep.random_search import RandomSearch
from plantar.sim.sweep.value_range import ValueRange

_MOST = 1000  # runs of a limit's search


def plan_from_texts(
    scene: str,
    grid: Sequence[str] = (),
    seeds: int | None = None,
    robot: str | None = None,
    settings: Sequence[str] = (),
    first_seed: int = 0,
    *,
    limit: str | None = None,
    within: float = 0.1,
    random: Sequence[str] = (),
) -> Sweep | LimitSearch | RandomSearch:
    """Returns the checked plan of `scene`, `grid`, `robot`, `settings` and `first_seed`, as of `Sweep.from_texts`.

    `seeds` are the most at each grid point with a limit; None for 1, or 1000 with a limit. `limit` and `random` are
    texts "key=from:to" of a searched setting and of drawn ones; `within`, a share of the limit, is the width of its
    95 % interval that ends the search. An InputError if texts are malformed or contradict.
    """
    if limit is not None and random:
        raise InputError("a limit is searched along one setting; leave out --random, or use --grid along with --limit")
    count = seeds if seeds is not None else 1 if limit is None else _MOST
    sweep = Sweep.from_texts(scene, grid, count, robot, settings, first_seed)
    if limit is not None:
        return LimitSearch(sweep, ValueRange.from_text(limit, "limit"), within)
    return RandomSearch(sweep, tuple(ValueRange.from_text(text, "random") for text in random)) if random else sweep
