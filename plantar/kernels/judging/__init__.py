"""Figures that the judge of a walk follows at each physics step and tick."""
