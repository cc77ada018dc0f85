"""Mountable tactile shoes: from a foot's geometry to a printable part and its layout file.

A `Foot` is read from a mesh or given by its dimensions; `build_shoe` fits the taxels and builds the solid;
`export_shoe` writes the files and checks what it wrote. Lengths inside this package are in mm; the layout is in m.
"""

from shoes.build import Shoe, ShoeBuild, build_shoe
from shoes.checks.check import ShoeCheck
from shoes.fit.taxels import TaxelFit, fit_taxels
from shoes.foot.foot import Foot, foot_from_dimensions, foot_from_outline
from shoes.foot.foot_mesh import foot_from_mesh
from shoes.papers.export import ShoeReport, export_shoe
from shoes.parameters import ShoeParameters, read_parameters
from shoes.plan.shoe_plan import ShoePlan

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
