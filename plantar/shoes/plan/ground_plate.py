"""Printed plate between the ground and a few cells, in place of a soft pad: what presses on a part of it acts on them.

A rigid plate on cells at its corners carries a load anywhere within their hull, and all of the load may act on one of
them. The plate is a beam on two supports, the cells at heel and toes, with the load case in its middle: M = F L / 4,
and stress 6 M / (b t^2). In mm.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import shapely

from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.strength import LoadCase, Member

_STEP = 0.5  # mm of the plate's thickness


def has_ground_plate(plan: ShoePlan) -> bool:
    """Whether a plan's cells are a few, below which a plate lies."""
    return plan.cell is not None and plan.cell.count > 0.0


def ground_plate(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> Member:
    """Gives the plate of a plan as a beam under a load, by parameters."""
    p = parameters
    centres = np.array([c.centroid.coords[0] for c in plan.cells])
    span = float(np.ptp(centres[:, 0]))
    _, low_y, _, high_y = plan.contact.bounds
    width = float(high_y - low_y)
    material = p.printed
    allowed = material.strength / p.safety
    moment = 0.25 * load.force * span / width  # of a mm of the width
    needed = math.sqrt(6.0 * moment / allowed)
    thickness = max(p.pad_thickness, 1e-9)
    stress = 6.0 * moment / thickness**2
    bent = load.force * span**3 / (48.0 * material.modulus * width * thickness**3 / 12.0)
    figures = (span, thickness, needed, stress, allowed, bent)
    return Member("plate below the cells", "beam on two supports", *(round(v, 3) for v in figures))


def plated(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters with a printed plate, as thick as it needs to be, where a plan's cells are a few; and a note."""
    p = parameters
    if not has_ground_plate(plan) or p.strengthen == "no":
        return p, ()
    needed = ground_plate(plan, load, p).needed
    _, most, _, _ = ShoeParameters.range_of("pad_thickness")
    thickness = min(most, max(p.pad_thickness, math.ceil(needed / _STEP) * _STEP))
    note = (
        f"the pad is a printed plate of {thickness:g} mm: on {len(plan.cells)} cells it carries what presses on a part "
        "of the sole"
    )
    return replace(p, pad_kind="plate", pad_foam=0.0, pad_thickness=thickness), (note,)


def plate_carries(plan: ShoePlan, held: Any) -> float:
    """Gives 1 if a load in the middle of held, a shapely part of the face, acts on the cells through the plate; else,
    as the plate tips, 0.
    """
    hull = shapely.MultiPoint([c.centroid for c in plan.cells]).convex_hull
    return 1.0 if hull.covers(held.centroid) else 0.0
