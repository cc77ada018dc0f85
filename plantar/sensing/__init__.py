"""Taxel signals, one at a time: force, proximity, temperature, health."""
