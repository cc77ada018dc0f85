"""Criteria that a run failed."""

import math
from typing import Any


def unmet(*criteria: tuple[bool, str, float, float, str]) -> list[dict[str, Any]]:
    """Those of the `criteria` that are not met, for summaries.

    Each: whether met, name_with_underscores, value (not finite becomes None), limit, text.
    """
    return [
        {
            "criterion": name,
            "value": value if isinstance(value, int) else round(float(value), 6) if math.isfinite(value) else None,
            "limit": limit,
            "text": text,
        }
        for met, name, value, limit, text in criteria
        if not met
    ]
