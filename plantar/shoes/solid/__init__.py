"""The solids, built with OpenCascade: body, arcs, STEP, pad, retention, lettering."""
