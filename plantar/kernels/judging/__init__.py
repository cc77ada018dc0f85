"""Figures of a walk's judge, at each physics step and tick."""
