"""Simulation: robots, terrain, skin and scenes in MuJoCo, and the truth that judges them."""
