"""Fusion of many tasks' demands to one torque: weighted, projected, in strict order, or within limits."""
