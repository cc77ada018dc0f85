"""Skin anywhere on a body: its taxels, what presses, what they measure."""
