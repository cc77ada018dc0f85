"""Skin anywhere on a body: where its taxels are, what presses on them, and what they measure."""
