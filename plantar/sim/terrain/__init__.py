"""Terrain: ground unknown to the controller, one kind a file."""

from plantar.sim.terrain.beam import Beam
from plantar.sim.terrain.block import Block
from plantar.sim.terrain.course import Course
from plantar.sim.terrain.ground import (
    CORNERS,
    FLAT,
    GROUND_CONTACT,
    GROUND_GROUP,
    Flat,
    Footprint,
    Ground,
    Motion,
    PlannedFeet,
    Solid,
    Terrain,
)
from plantar.sim.terrain.kinds import terrain_kinds
from plantar.sim.terrain.mixed import Mixed
from plantar.sim.terrain.stones import Partial, Pebbles, Stones, Uneven
from plantar.sim.terrain.way import Relief, Slopes, Stairs

__all__ = [
    "CORNERS",
    "FLAT",
    "GROUND_CONTACT",
    "GROUND_GROUP",
    "Beam",
    "Block",
    "Course",
    "Flat",
    "Footprint",
    "Ground",
    "Mixed",
    "Motion",
    "Partial",
    "Pebbles",
    "PlannedFeet",
    "Relief",
    "Slopes",
    "Solid",
    "Stairs",
    "Stones",
    "Terrain",
    "Uneven",
    "terrain_kinds",
]
