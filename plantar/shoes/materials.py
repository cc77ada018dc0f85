"""Printed materials, typical of their data sheets: PA12 multi-jet fusion and laser sintering; PETG, PLA and TPU (95
Shore A) filament; resin tough photopolymers. For a critical part use the maker's data.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

__all__ = ["MATERIALS", "Material"]


@dataclass(frozen=True)
class Material:
    """A printed material.

    Attributes:
        process: How it is printed where the parameter `process` does not state it.
        density: In g/cm^3.
        modulus: Young's modulus in MPa.
        strength: Tensile strength within a layer in MPa.
        across: Share of the strength across the layers, 0..1.
        strain: Allowed strain of a clip each time it is put on, 0..1.
    """

    name: str
    process: str
    density: float
    modulus: float
    strength: float
    across: float
    strain: float

    def with_density(self, density: float) -> Material:
        """The material with another density in g/cm^3; 0 keeps its own."""
        return replace(self, density=density) if density > 0.0 else self


MATERIALS: dict[str, Material] = {
    m.name: m
    for m in (
        Material("PA12", "MJF", 1.01, 1700.0, 48.0, 0.85, 0.040),
        Material("PETG", "FDM", 1.27, 2000.0, 45.0, 0.55, 0.025),
        Material("PLA", "FDM", 1.24, 3000.0, 50.0, 0.50, 0.015),
        Material("TPU", "FDM", 1.21, 30.0, 30.0, 0.80, 0.0),
        Material("resin", "SLA", 1.18, 1600.0, 42.0, 0.90, 0.015),
    )
}
"""The printed materials by name."""
