"""Mountable tactile shoes: from a foot's geometry to a printable part and its layout file.

A `Foot` is read from a mesh or given by its dimensions; `build_shoe` fits the taxels and builds the solid;
`export_shoe` writes the files and checks what it wrote. Lengths inside this package are in mm; the layout is in m.
"""

from shoes.build import Shoe, ShoeBuild, build_shoe
from shoes.check import ShoeCheck
from shoes.export import ShoeReport, export_shoe
from shoes.fit import LatticeFit, fit_lattice
from shoes.foot import Foot, foot_from_dimensions, foot_from_mesh
from shoes.parameters import ShoeParameters, read_parameters
from shoes.plan import ShoePlan

__all__ = [
    "Foot",
    "LatticeFit",
    "Shoe",
    "ShoeBuild",
    "ShoeCheck",
    "ShoeParameters",
    "ShoePlan",
    "ShoeReport",
    "build_shoe",
    "export_shoe",
    "fit_lattice",
    "foot_from_dimensions",
    "foot_from_mesh",
    "read_parameters",
]
