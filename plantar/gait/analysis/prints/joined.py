"""Groups of places that are joined by way of their neighbours."""

from collections.abc import Iterable, Iterator, Mapping


def joined(neighbours: Mapping[int, Iterable[int]]) -> Iterator[list[int]]:
    """Yields places that are joined, by the `neighbours` of each; others join none.

    Example:
        >>> list(joined({1: [2], 2: [1, 3], 5: [3]}))
        [[1, 2], [5]]
    """
    left = dict.fromkeys(neighbours)
    for start in neighbours:
        group = [start] if start in left else []
        left.pop(start, None)
        for place in group:  # which grows
            found = [other for other in dict.fromkeys(neighbours[place]) if other in left]
            group += found
            for other in found:
                del left[other]
        if group:
            yield group
