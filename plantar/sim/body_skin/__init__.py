"""Skin on machines and robots: where its taxels are, and what its electronics measure."""
