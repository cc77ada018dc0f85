"""Orders of a design's rows, by which the levels of a factor are given to other values."""

import math
from collections.abc import Iterator, Sequence
from itertools import combinations, permutations, product

import numpy as np
from numpy.typing import NDArray

_SEED = 1
_BLOCK = 2_000_000  # Values that are permuted together


def blocks_of_orders(
    level: NDArray[np.int64], exchanged: Sequence[NDArray[np.int64]], values: int, most: int
) -> Iterator[NDArray[np.int64]]:
    """Yields row numbers (b, r) of orders, the observed one first, some at a time.

    Args:
        level: Level (r,) of each row.
        exchanged: Rows that are exchanged with one another, of each group of rows.
        values: Values a row.
        most: Orders that are drawn where there are more.

    Example:
        >>> next(blocks_of_orders(np.array([0, 1]), [np.array([0, 1])], 1, 10)).tolist()
        [[0, 1], [1, 0]]
    """
    rows = len(level)
    size = max(1, _BLOCK // (rows + values))
    block: list[NDArray[np.int64]] = []
    for order in _orders(level, exchanged, most):
        block.append(order)
        if len(block) == size:
            yield np.array(block)
            block = []
    if block:
        yield np.array(block)


def _orders(level: NDArray[np.int64], groups: Sequence[NDArray[np.int64]], most: int) -> Iterator[NDArray[np.int64]]:
    """Every order of rows that gives other levels, or the observed one and drawn ones."""
    rows = np.arange(len(level))
    counts = [_arrangements(level[group]) for group in groups]
    if math.prod(counts) <= most:
        for choice in product(*(list(_all_orders(group, level)) for group in groups)):
            order = rows.copy()
            for group, chosen in zip(groups, choice, strict=True):
                order[group] = chosen
            yield order
        return
    random = np.random.default_rng(_SEED)
    yield rows
    same = len({len(group) for group in groups}) == 1
    table = np.array(groups) if same else None
    for _ in range(most - 1):
        order = rows.copy()
        if table is not None:
            order[table.ravel()] = random.permuted(table, axis=1).ravel()
        else:
            for group in groups:
                order[group] = random.permutation(group)
        yield order


def _arrangements(levels: NDArray[np.int64]) -> int:
    _, counts = np.unique(levels, return_counts=True)
    return math.factorial(len(levels)) // math.prod(math.factorial(int(n)) for n in counts)


def _all_orders(group: NDArray[np.int64], level: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
    """Orders of a group's rows, one for each way in which the levels may be given to the values."""
    names, counts = np.unique(level[group], return_counts=True)
    if len(group) == len(names):
        yield from (np.array(order) for order in permutations(group.tolist()))
        return
    yield from _dealt(group, [(group[level[group] == name], int(n)) for name, n in zip(names, counts, strict=True)])


def _dealt(group: NDArray[np.int64], places: Sequence[tuple[NDArray[np.int64], int]]) -> Iterator[NDArray[np.int64]]:
    """Orders of a group whose rows are dealt to the places of each level."""
    index = {int(row): i for i, row in enumerate(group)}

    def deal(left: tuple[int, ...], depth: int) -> Iterator[dict[int, int]]:
        if depth == len(places):
            yield {}
            return
        own, count = places[depth]
        for chosen in combinations(left, count):
            rest = tuple(row for row in left if row not in chosen)
            for more in deal(rest, depth + 1):
                yield {**dict(zip(map(int, own), chosen, strict=True)), **more}

    for dealt in deal(tuple(map(int, group)), 0):
        order = group.copy()
        for place, row in dealt.items():
            order[index[place]] = row
        yield order
