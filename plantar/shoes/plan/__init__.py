"""Dimensions decided: block, heel, wiring."""
