"""How many examples a property is tried on, where it needs more or fewer than others."""

from typing import Any

from hypothesis import settings

_USUAL = 40  # of the profile "same", for which tests state their numbers


def examples(count: int, **others: Any) -> settings:
    """Settings with `count` examples; fewer or more with a profile of fewer or more, as the short tests have."""
    return settings(max_examples=max(1, count * settings().max_examples // _USUAL), **others)
