"""Solids by OpenCascade: body, arcs, STEP, pad, retention, lettering."""
