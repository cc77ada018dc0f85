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
    """Make and check a plan from the command line's texts.

    Args:
        scene: As of `Sweep.from_texts`, like `grid`, `robot`, `settings` and `first_seed`.
        seeds: Number of seeds; with a limit the most at each grid point. None for 1, or 1000 with a limit.
        limit: Text "key=from:to" of searched setting.
        within: Width of the limit's 95 % interval, as a share of limit, that ends the search.
        random: Texts "key=from:to" of drawn settings.

    Returns:
        The plan.

    Raises:
        InputError: If texts are malformed or contradict.
    """
    if limit is not None and random:
        raise InputError("a limit is searched along one setting; leave out --random, or use --grid along with --limit")
    count = seeds if seeds is not None else 1 if limit is None else _MOST
    sweep = Sweep.from_texts(scene, grid, count, robot, settings, first_seed)
    if limit is not None:
        return LimitSearch(sweep, ValueRange.from_text(limit, "limit"), within)
    if random:
        return RandomSearch(sweep, tuple(ValueRange.from_text(text, "random") for text in random))
    return sweep
