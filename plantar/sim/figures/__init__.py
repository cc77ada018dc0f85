"""Figures and videos of a run."""
