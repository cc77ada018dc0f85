"""Fusion of task demands to a torque: weighted, projected, strictly ordered, or limited."""
