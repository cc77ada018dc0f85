"""How much a test draws that needs more or less than others: less with a profile of less, as the short tests have."""

from typing import Any

from hypothesis import settings

_USUAL = 40  # of the profile "same", for which tests state their numbers


def scaled(count: int) -> int:
    """Of `count` draws as many as the present profile of hypothesis makes of its usual ones."""
    return max(1, count * settings().max_examples // _USUAL)


def examples(count: int, **others: Any) -> settings:
    """Settings of hypothesis with `count` examples, scaled."""
    return settings(max_examples=scaled(count), **others)
