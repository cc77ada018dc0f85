"""Mountable tactile shoes: a foot's geometry (`Foot`) becomes a printable part (`build_shoe`) and files
(`export_shoe`).

Lengths here are in mm, in the layout in m. Names below load at first use (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plantar.shoes.build import Shoe, ShoeBuild, build_shoe
    from plantar.shoes.checks.check import ShoeCheck
    from plantar.shoes.fit.taxels import TaxelFit, fit_taxels
    from plantar.shoes.foot.foot import Foot, foot_from_dimensions, foot_from_outline
    from plantar.shoes.foot.foot_mesh import foot_from_mesh
    from plantar.shoes.papers.export import ShoeReport, export_shoe
    from plantar.shoes.parameters import ShoeParameters, read_parameters
    from plantar.shoes.plan.shoe_plan import ShoePlan

__all__ = [
    "Foot",
    "Shoe",
    "ShoeBuild",
    "ShoeCheck",
    "ShoeParameters",
    "ShoePlan",
    "ShoeReport",
    "TaxelFit",
    "build_shoe",
    "export_shoe",
    "fit_taxels",
    "foot_from_dimensions",
    "foot_from_mesh",
    "foot_from_outline",
    "read_parameters",
]

_PLACES = {
    "Foot": "foot.foot",
    "Shoe": "build",
    "ShoeBuild": "build",
    "ShoeCheck": "checks.check",
    "ShoeParameters": "parameters",
    "ShoePlan": "plan.shoe_plan",
    "ShoeReport": "papers.export",
    "TaxelFit": "fit.taxels",
    "build_shoe": "build",
    "export_shoe": "papers.export",
    "fit_taxels": "fit.taxels",
    "foot_from_dimensions": "foot.foot",
    "foot_from_mesh": "foot.foot_mesh",
    "foot_from_outline": "foot.foot",
    "read_parameters": "parameters",
}

if not TYPE_CHECKING:  # a type checker reads the imports above, and reports a name that does not exist

    def __getattr__(name: str) -> object:
        """Load a public name at first use."""
        if name not in _PLACES:
            raise AttributeError(f"module 'plantar.shoes' has no attribute {name!r}")
        missing_libraries = import_module("plantar.common.optional_library").missing_libraries
        with missing_libraries("shoes"):
            value = getattr(import_module(f"plantar.shoes.{_PLACES[name]}"), name)
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        """The public names, loaded or not, and what else the module holds."""
        return sorted({*globals(), *__all__})
