"""What a shoe weighs: print, pad, taxels and board."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.solid.pad import pad_surface, volume_of

__all__ = ["BOARD_UP", "Weights", "weigh"]

_FOAM_DENSITY = 0.32  # g/cm^3, of microcellular foams (PORON 4701-30, data sheet)
_BOARD_DENSITY = 1.85e-3  # g/mm^3, glass fibre and copper
BOARD_UP = 12.0
"""Length in mm of board above the shelf."""


@dataclass(frozen=True)
class Weights:
    """Masses of one shoe in g: print, pad, taxels (their area times protrusion and pocket depth) and board."""

    printed: float
    pad: float
    skin: float
    board: float

    @property
    def total(self) -> float:
        """All together."""
        return self.printed + self.pad + self.skin + self.board

    def as_dict(self) -> dict[str, float]:
        """Each mass and their `total`, in g."""
        return asdict(self) | {"total": round(self.total, 2)}


def weigh(shoe: Shoe, build: ShoeBuild, volume: float) -> Weights:
    """Gives the masses of a shoe of a build with a printed volume in mm^3."""
    p = build.parameters
    pad = volume_of(pad_surface(shoe.plan, p)) if p.pad_thickness > 0.0 else 0.0
    board = p.board_length * BOARD_UP * p.board_thickness * _BOARD_DENSITY if shoe.plan.heel.board else 0.0
    return Weights(
        printed=round(volume / 1000.0 * p.printed.density, 2),
        pad=round(pad / 1000.0 * (_FOAM_DENSITY if p.pad_foam > 0.0 else p.pad_density), 2),
        skin=round(_skin(shoe, p) / 1000.0 * p.skin_density, 2),
        board=round(board, 2),
    )


def _skin(shoe: Shoe, p: ShoeParameters) -> float:
    plan = shoe.plan
    if plan.cell is not None and plan.lands:
        return float(sum(q.area for q in plan.pockets)) * plan.cell.thickness
    heads, bases = sum(c.area for c in plan.cells), sum(q.area for q in plan.pockets)
    return float(heads) * p.taxel_protrusion + float(bases) * p.pocket_depth
