"""Signals of taxels, one at a time: force, proximity, temperature, health."""
