"""Figures and pages of an analysis."""
