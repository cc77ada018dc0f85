"""Footprint: shape, regions, and platform cells."""
