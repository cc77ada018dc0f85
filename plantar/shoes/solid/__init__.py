"""The solids: body, kernel, arcs, STEP, pad, retention, lettering. The only room that builds with OpenCascade."""
