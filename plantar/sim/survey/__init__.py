"""How a robot stands and walks: found in its model, written into a robot file, and checked."""
